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
//
// Of a preload P + P_2 eta^2 the static part alone has the factor q, while friction and force act on both,
// and springs k_3 y^3 are not homogeneous, so that the peak is
//
//   f Y_max(P m q/f; P_2 m/f),   with cubic springs   Y_max(P m q; P_2 m, F f):
//
// there Y_max is a family of envelopes (envelope_family.hpp) over the factors behind the semicolon, and over
// m as well where elements have a friction coefficient of their own beside a normal force. It is made of a
// grid of designs that is refined until quantiles change by no more than a twentieth of what sampling leaves
// open, on average, at most until each sample has a design of its own.

#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "arcslip/problems/ridges/envelope_family.hpp"

namespace arcslip::problems {

/// Distribution of a factor on a nominal value.
struct Scatter {
  /// The distribution.
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
  Scatter friction;                                   ///< m, on mu
  Scatter preload;                                    ///< q, on P
  Scatter force;                                      ///< f, on F
  std::size_t samples = 4000;                         ///< N
  std::uint64_t seed = 1;                             ///< of the samples
  std::vector<double> quantiles = {0.05, 0.5, 0.95};  ///< each > 0 and < 1
  std::size_t patterns = 0;  ///< of whole rings: how many are made, in place of all other samples
};

/// What a response is not proportional to force and preload together for.
struct Inhomogeneity {
  bool grows = false;             ///< P_2 /= 0
  bool has_springs = false;       ///< that are cubic, or other elements
  bool has_own_friction = false;  ///< whether mu enters by elements, and not as a factor on P alone
};

/// The sampled distribution of the highest peak at any nominal preload. Envelopes are families of one where
/// the response is homogeneous.
class PeakDistribution {
 public:
  /// Throws std::invalid_argument without samples.
  explicit PeakDistribution(const Uncertainty& uncertainty, Inhomogeneity inhomogeneity = {});

  /// Of so many rings, each with an envelope of its own, which no factor tells.
  static PeakDistribution of_patterns(std::size_t count);

  /// The least and the largest of z - x, x = ln P of a nominal preload, with z of EnvelopeFamily: of
  /// ln(m q/f) without other factors.
  double lowest() const { return samples_.front().shift; }
  double highest() const { return samples_.back().shift; }

  /// Factors of all samples, in the order in which a family of each by itself has them.
  std::vector<DesignFactors> factors() const;

  /// ln of the quantiles of the highest peak at the nominal preload of which x is ln P: of N samples in
  /// ascending order the one at position ceil(N p), counted from one.
  std::vector<double> log_quantiles(const EnvelopeFamily& envelope, double x,
                                    const std::vector<double>& probabilities) const;

  /// The same with the standard error that each has as one of so many samples: half the distance of the
  /// values one standard deviation of the rank, sqrt(N p (1 - p)), before and behind it, or one rank where
  /// one factor alone scatters, of which each stratum has a sample. At a cliff of the envelope, where few
  /// samples lie, these are far apart.
  struct Quantile {
    double log_value;  ///< ln Y
    double error;      ///< of log_value
  };
  /// One for each probability, in their order.
  std::vector<Quantile> quantiles(const EnvelopeFamily& envelope, double x,
                                  const std::vector<double>& probabilities) const;

  /// The x within from .. to at which a quantile is lowest. It is looked for in steps of 0.02 and at the ends
  /// of the envelope's pieces, then refined where it is lowest.
  double lowest_quantile(const EnvelopeFamily& envelope, double from, double to, double probability) const;

 private:
  struct Sample {
    double shift;  ///< z - x
    double scale;  ///< ln f, where the response is proportional to it
    DesignFactors factors;
  };

  /// ln of the highest peaks of all samples.
  std::vector<double> values(const EnvelopeFamily& envelope, double x) const;

  bool is_stratified_ = false;   ///< whether one factor alone scatters
  std::vector<Sample> samples_;  ///< by rising shift
};

/// Quantiles of the highest peak at one nominal preload, in the order of Uncertainty::quantiles.
struct QuantileRow {
  double preload;                   ///< P
  std::vector<double> Y;            ///< one for each quantile
  std::vector<double> errors = {};  ///< standard errors of sampling, relative
};

/// One design's peaks under scatter.
struct UncertainPeaks {
  static constexpr double probability = 0.95;  ///< of the quantile that is minimised

  std::vector<QuantileRow> rows;  ///< over the range, the nominal optimum and the one below among them
  double preload = 0;             ///< at which the 95 % quantile is lowest
  double Y = 0;                   ///< that quantile there
  double Y_nominal = 0;           ///< that quantile at the optimum that scatter knows nothing of
  double error = 0;               ///< estimate of the relative error of both by interpolation; that of the
                                  ///< rows is on average a small part of their own errors
  double sampling_error = 0;      ///< relative standard error of Y as a quantile of the samples
  std::string failure;            ///< why there are no rows, or empty
};

/// The envelope of the design with these factors over preloads from .. to, with its estimated error in
/// ln Y_max. May throw std::runtime_error.
using EnvelopeOver =
    std::function<std::pair<EnvelopeCurve, double>(const DesignFactors& factors, double from, double to)>;

/// Samples the scatter of a design that `nominal` is the study of, over the same range.
UncertainPeaks study_uncertainty(const PreloadRange& range, const Uncertainty& uncertainty,
                                 Inhomogeneity inhomogeneity, const PreloadStudy& nominal,
                                 const EnvelopeOver& envelope_over);

/// Studies a design that `nominal` is the study of, over the same range. Throws std::invalid_argument for
/// systems that study_preload refuses.
UncertainPeaks study_uncertainty(const SystemParameters& system, const PreloadRange& range,
                                 const Uncertainty& uncertainty, const PreloadStudy& nominal,
                                 const continuation::TraceOptions& options = {});

/// The quantiles of so many rings over a range of nominal preloads, each ring's highest peak by its envelope;
/// `optimum` is the best preload of the equal ring.
UncertainPeaks study_patterns(const PreloadRange& range, const std::vector<EnvelopeFamily::Curve>& rings,
                              const std::vector<double>& quantiles, double optimum);

/// The system with these factors.
SystemParameters scaled(SystemParameters system, const DesignFactors& factors);

}  // namespace arcslip::problems
