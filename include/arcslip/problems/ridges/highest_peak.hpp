#pragma once

// The height of the highest peak of a response, M(x) = max over its peaks of L, x = ln b, and where it is
// lowest. Responses are sampled at some x; their peaks have exact slopes dL/dx, and those of neighbouring
// samples that belong together are joined by cubics. Where these leave room for a lower M, by what their
// errors are at the samples already there, another response is taken, until none is left.

#include <optional>
#include <utility>
#include <vector>

#include "arcslip/problems/ridges/peak_interval.hpp"

namespace arcslip::problems {

/// Keeps the samples, and refers to the responses of which they are taken. To be used from one thread.
class HighestPeak {
 public:
  /// How responses are looked at.
  enum class Looks {
    whole,    ///< all of them are traced
    followed  ///< their peaks are followed from neighbours on both sides that have the same ones, if these do
  };

  /// Samples b = from .. to, both > 0, and the values `wanted` between them. Throws std::runtime_error where
  /// a response cannot be traced or has no peak.
  HighestPeak(ResponsePeaks& responses, double from, double to, const std::vector<double>& wanted,
              Looks looks = Looks::whole);

  /// Where M is lowest.
  struct Lowest {
    /// What makes M lowest there.
    OptimumKind kind = OptimumKind::smooth;
    double x = 0;                      ///< of a sample
    std::size_t peak = 0;              ///< its highest, or that which is so just below x
    std::optional<std::size_t> other;  ///< of an exchange, that which takes over
    double low = 0;                    ///< M <= M(x) + ln 2 from here, in x, ...
    double high = 0;                   ///< ... to here; an end of the range where it holds beyond it
  };
  /// Takes further samples as it needs them, the ends of the range within a factor 2 being known to `precise`
  /// in x. Throws std::runtime_error where a response cannot be traced.
  Lowest lowest(double precise = 1e-6);

  /// Takes samples where two peaks change places as the highest.
  void settle_exchanges();

  /// Takes more samples until the cubics that form M are good to `tolerance`, as their errors show, or there
  /// are `most`. Returns the largest error that is left.
  double refine(double tolerance, std::size_t most);

  /// All that were taken, by rising x.
  const std::vector<PeakSample>& samples() const { return samples_; }
  const PeakSample& sample(double x) const { return samples_[position(x)]; }

  /// b at x; of a sample as it was given, not as its logarithm gives it back.
  double value(double x) const;

  /// Cubics of all ridges between neighbouring samples.
  std::vector<EnvelopePiece> pieces() const;

 private:
  const PeakSample& add(double x);
  const PeakSample& add(double x, double value);
  std::size_t position(double x) const;
  PeakInterval interval(std::size_t i) const;
  double fourth_order(std::size_t i) const;
  std::optional<double> room_below(double level) const;
  void bound();
  double least() const;
  double next_place(std::size_t low, bool stagnates) const;
  std::pair<double, double> valley();
  void settle(Lowest& lowest);
  void settle_corner(double low, double high, Lowest& lowest) const;
  bool settle_exchange(const PeakSample& here, Lowest& lowest) const;
  bool settle_flat(Lowest& lowest);
  double leaves(double x, double level, int way, double precision);

  PeakSample whole_sample(double x, double value);
  bool is_confirmed(const Lowest& lowest);

  ResponsePeaks& responses_;
  Looks looks_;
  std::vector<PeakSample> samples_;
};

}  // namespace arcslip::problems
