#pragma once

// The highest peak of dampers as they are made: friction, preload and force scatter about their nominal
// values by independent random factors m, q and f. A linear structure with friction is homogeneous,
//
//   Y(l F, l P; eta) = l Y(F, P; eta)   for every l > 0,
//
// and mu enters through P = mu p_0/k_B alone, so that the peak of such a damper at the nominal preload P is
//
//   f Y_max(P m q/f):
//
// one envelope Y_max(P) over a range wide enough for all factors gives the whole distribution. It is sampled
// by a Latin hypercube, the factors being inverse distribution functions of stratified numbers.

#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "arcslip/problems/ridges/envelope_curve.hpp"

namespace arcslip::problems {

/// Distribution of a factor on a nominal value.
struct Scatter {
  enum class Kind { none, lognormal, uniform };

  Kind kind = Kind::none;  ///< none: the factor is 1
  double deviation = 0;    ///< lognormal: standard deviation of its logarithm, whose median is 0
  double low = 1;          ///< uniform: from low > 0 ...
  double high = 1;         ///< ... to high > low

  /// ln of the factor below which the part u of all lies, 0 < u < 1.
  double log_quantile(double u) const;
};

/// What scatters, and how it is sampled. The same seed gives the same samples everywhere.
struct Uncertainty {
  Scatter friction;
  Scatter preload;
  Scatter force;
  std::size_t samples = 4000;
  std::uint64_t seed = 1;
  std::vector<double> quantiles = {0.05, 0.5, 0.95};  ///< each > 0 and < 1
};

/// The sampled distribution of the highest peak at any nominal preload.
class PeakDistribution {
 public:
  /// Throws std::invalid_argument without samples.
  explicit PeakDistribution(const Uncertainty& uncertainty);

  /// The least and the largest of ln(m q/f): with x = ln P of a nominal preload an envelope is needed from
  /// x + lowest() to x + highest().
  double lowest() const { return samples_.front().shift; }
  double highest() const { return samples_.back().shift; }

  /// ln of the quantiles of the highest peak at the nominal preload of which x is ln P: of N samples in
  /// ascending order the one at position ceil(N p), counted from one.
  std::vector<double> log_quantiles(const EnvelopeCurve& envelope, double x,
                                    const std::vector<double>& probabilities) const;

  /// The same with the standard error that each has as one of so many samples: half the distance of the
  /// values one standard deviation of the rank, sqrt(N p (1 - p)), before and behind it, or one rank where
  /// one factor scatters, of which each stratum has a sample. At a cliff of the envelope, where few samples
  /// lie, these are far apart.
  struct Quantile {
    double log_value;
    double error;  ///< of log_value
  };
  std::vector<Quantile> quantiles(const EnvelopeCurve& envelope, double x,
                                  const std::vector<double>& probabilities) const;

  /// The x within from .. to at which a quantile is lowest. It is looked for in steps of 0.02 and at the ends
  /// of the envelope's pieces, then refined where it is lowest.
  double lowest_quantile(const EnvelopeCurve& envelope, double from, double to, double probability) const;

 private:
  struct Sample {
    double shift;      ///< ln(m q/f)
    double log_force;  ///< ln f
  };

  /// ln of the highest peaks of all samples.
  std::vector<double> values(const EnvelopeCurve& envelope, double x) const;

  int factors_ = 0;              ///< that scatter
  std::vector<Sample> samples_;  ///< by rising shift
};

/// Quantiles of the highest peak at one nominal preload, in the order of Uncertainty::quantiles.
struct QuantileRow {
  double preload;
  std::vector<double> Y;
  std::vector<double> errors = {};  ///< standard errors of sampling, relative
};

/// One design's peaks under scatter.
struct UncertainPeaks {
  static constexpr double probability = 0.95;  ///< of the quantile that is minimised

  std::vector<QuantileRow> rows;  ///< over the range, the nominal optimum and the one below among them
  double preload = 0;             ///< at which the 95 % quantile is lowest
  double Y = 0;                   ///< that quantile there
  double Y_nominal = 0;           ///< that quantile at the optimum that scatter knows nothing of
  double error = 0;               ///< estimate of the relative error of all Y by the envelope's interpolation
  double sampling_error = 0;      ///< relative standard error of Y as a quantile of the samples
  std::string failure;            ///< why there are no rows, or empty
};

/// The envelope over preloads from .. to, with its estimated error in ln Y_max. May throw std::runtime_error.
using EnvelopeOver = std::function<std::pair<EnvelopeCurve, double>(double from, double to)>;

/// Samples the scatter of a design that `nominal` is the study of, over the same range; its response must be
/// proportional to force and preload together.
UncertainPeaks study_uncertainty(const PreloadRange& range, const Uncertainty& uncertainty,
                                 const PreloadStudy& nominal, const EnvelopeOver& envelope_over);

/// Studies a design that `nominal` is the study of, over the same range. Throws std::invalid_argument for
/// systems that study_preload refuses and for preload_growth != 0, where homogeneity does not hold.
UncertainPeaks study_uncertainty(const SystemParameters& system, const PreloadRange& range,
                                 const Uncertainty& uncertainty, const PreloadStudy& nominal,
                                 const continuation::TraceOptions& options = {});

}  // namespace arcslip::problems
