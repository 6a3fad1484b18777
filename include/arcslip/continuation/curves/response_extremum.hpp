#pragma once

// An extremum of an observable along the branch over one parameter, whatever makes it: a zero of the slope,
// or a jump of it from one sign to the other. It is bracketed on the branch itself, so that nothing need be
// smooth but the branch on either side.

#include <optional>

#include "arcslip/continuation/path/corrector.hpp"
#include "arcslip/continuation/points/extended_problem.hpp"

namespace arcslip::continuation {

/// Searches along the branch through a point. The base is kept by reference.
class ResponseExtremum {
 public:
  /// `active` is the parameter's position, `observable` that of an observable with a gradient.
  ResponseExtremum(const Problem& base, Index active, Index observable);

  /// The extremum next to a guess.
  struct Found {
    BasePoint at;  ///< in the guess's regime
    double way;    ///< from the guess along the branch, in the base's scale
    bool corner;   ///< whether the slope jumps there
  };

  /// The peak or trough that is nearest to a guess within its regime, at the guess's other parameters; none
  /// within `farthest`.
  [[nodiscard]] std::optional<Found> next_to(const BasePoint& guess, bool peak, double farthest);

  /// Whether an extremum is a peak, as slopes on both sides tell that rounding does not hide, the next ones
  /// that do.
  [[nodiscard]] std::optional<bool> is_peak(const BasePoint& at);

  /// Sets the way that counts as forward: that of rising active parameter at this point. False where it is
  /// not known; the last one stays.
  [[nodiscard]] bool begin(const BasePoint& point);

 private:
  struct End {
    double way;
    double slope;
  };

  void start_at(const BasePoint& point);
  [[nodiscard]] bool go(double way);
  [[nodiscard]] std::optional<double> settle(double farthest);
  double slope(double way);
  bool is_corner(double way);
  std::optional<End> beside_jump(End from, End to);

  const Problem& base_;
  Index active_;
  Index observable_;
  Corrector corrector_;
  CurvePoint origin_;
  CurvePoint at_;
  Vector forward_;
  Gradient gradient_;
};

}  // namespace arcslip::continuation
