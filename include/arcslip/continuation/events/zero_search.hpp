#pragma once

// The first zero of one of the readings of a step.

#include <functional>
#include <limits>

#include "arcslip/continuation/path/readings.hpp"

namespace arcslip::continuation {

/// What counts as a zero.
struct ZeroOptions {
  bool jumps_count = true;  ///< where it jumps across zero: a derivative does so at a corner
  double left_over = 0.01;  ///< of its values around: more is left of a function only where it jumps
  /// What a function must come from for a zero that it only touches to count.
  double least_touched = std::numeric_limits<double>::infinity();
};

/// Keeps references to both, which must outlive it.
class ZeroSearch {
 public:
  /// Of the step that the stepper has attempted.
  ZeroSearch(const Stepper& stepper, Readings& readings, const ZeroOptions& options = {})
      : stepper_(stepper), readings_(readings), options_(options) {}

  /// In (from, to]; `sign` is that before the zero, 0 if unknown. At `to` a value below `tolerance` of the
  /// change is zero.
  Zero first(std::size_t which, int sign, double from, double to, double tolerance);

  /// A zero that the signs at both ends tell of, where rounding hides all others.
  Zero by_sign(const Node& a, const Node& b, int sign, std::size_t which);

  /// A function in pieces, by which readings it and the number of its piece are.
  struct PiecewiseFunction {
    std::size_t value;
    std::size_t piece;
  };

  /// That of one, by its signs at both ends and between its pieces; where there may be `two` on one also by
  /// that in the middle. A little behind it, where the derivatives are those of what follows.
  Zero first_of_pieces(const PiecewiseFunction& of, int sign, bool two, double from, double to);

  /// What rounding moves a place by: the scale makes points of order 1.
  static constexpr double no_way = 1e-14;

 private:
  static constexpr double finest_ = 1e-3;  // of a step: in less than this it is not cut into pieces
  using ValueAt = std::function<std::optional<double>(double s)>;

  Zero first_between(const Node& a, const Node& b, int sign, double tolerance, std::size_t which);
  double just_ahead(const Node& a, double width, int sign, std::size_t which);
  Zero just_behind_corner(double s, double to, int before, std::size_t which);
  bool is_left_over(const Node& a, const Node& b, std::size_t which);
  Zero locate(const Node& a, const Node& b, double size, const ValueAt& at) const;

  const Stepper& stepper_;
  Readings& readings_;
  ZeroOptions options_;
};

}  // namespace arcslip::continuation
