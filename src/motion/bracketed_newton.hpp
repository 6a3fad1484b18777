#pragma once

// Newton's method for a zero between two bounds at which the signs of a function differ. Where a step leaves
// them, as beside an extremum whose slope has the wrong sign by rounding, they are halved.

#include <algorithm>
#include <cmath>
#include <limits>

namespace arcslip {

/// `function` gives value and slope as a pair; it is below zero at `low` if it `rises`, above if not. To the
/// rounding of the function: until another step would do nothing, as the last two slopes tell.
template <class Function>
double bracketed_newton(const Function& function, double guess, double low, double high, bool rises) {
  constexpr double rounding = std::numeric_limits<double>::epsilon();
  constexpr double near = 1e-2;  // of the step before: a step that foretells the next one
  double x = guess;
  double last_step = std::numeric_limits<double>::infinity();
  double last_slope = 0;
  for (int i = 0; i < 200; ++i) {
    const auto [value, slope] = function(x);
    if (value == 0) return x;
    ((value > 0) == rises ? high : low) = x;
    double next = x - value / slope;
    const bool stays_within = next > low && next < high;
    if (!stays_within) next = 0.5 * (low + high);
    const double step = std::abs(next - x);
    x = next;
    const double after = 0.5 * std::abs((slope - last_slope) / slope) * step * step / last_step;
    const bool is_last = i > 0 && stays_within && step <= near * last_step && after <= rounding * std::abs(x);
    if (is_last || step <= 2 * rounding * std::abs(x)) break;
    last_step = step;
    last_slope = slope;
  }
  return x;
}

}  // namespace arcslip
