#pragma once

// Newton's method for a zero between two bounds at which the signs of a function differ. Where a step leaves
// them, as beside an extremum whose slope has the wrong sign by rounding, they are halved.

#include <algorithm>
#include <cmath>
#include <limits>

namespace arcslip {

/// `function` gives value and slope as a pair; it is below zero at `low` if it `rises`, above if not.
template <class Function>
double bracketed_newton(const Function& function, double guess, double low, double high, bool rises) {
  constexpr double rounding = 2 * std::numeric_limits<double>::epsilon();  // of x
  constexpr double last_step = 1e-9;  // of x: what the next one would be is its square
  double x = guess;
  for (int i = 0; i < 200; ++i) {
    const auto [value, slope] = function(x);
    if (value == 0) return x;
    ((value > 0) == rises ? high : low) = x;
    double next = x - value / slope;
    const bool is_between = next > low && next < high;
    const double step = std::abs(next - x);
    if (step <= (is_between ? last_step : rounding) * std::abs(x)) return std::clamp(next, low, high);
    if (!is_between) next = 0.5 * (low + high);
    if (std::abs(next - x) <= rounding * std::abs(x)) return next;
    x = next;
  }
  return x;
}

}  // namespace arcslip
