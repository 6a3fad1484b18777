#pragma once

// The first zero of one of the readings of a step.

#include <functional>
#include <limits>

#include "arcslip/continuation/path/readings.hpp"

namespace arcslip::continuation {

/// What counts as a zero.
struct ZeroOptions {
  bool jumps_count = true;  ///< where it jumps across zero: a derivative does so at a corner
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

 private:
  using ValueAt = std::function<std::optional<double>(double s)>;

  Zero first_between(const Node& a, const Node& b, int sign, double tolerance, std::size_t which);
  bool is_left_over(const Node& a, const Node& b, std::size_t which);
  Zero locate(const Node& a, const Node& b, double size, const ValueAt& at) const;

  const Stepper& stepper_;
  Readings& readings_;
  ZeroOptions options_;
};

}  // namespace arcslip::continuation
