#pragma once

// Newton's method for a zero between two bounds at which the signs of a function differ. Where a step leaves
// them, as beside an extremum whose slope has the wrong sign by rounding, they are halved.

#include <cmath>
#include <limits>

namespace arcslip {

/// `function` gives value and slope as a pair; it is below zero at `low` if it `rises`, above if not.
template <class Function>
double bracketed_newton(const Function& function, double guess, double low, double high, bool rises) {
  double x = guess;
  for (int i = 0; i < 200; ++i) {
    const auto [value, slope] = function(x);
    if (value == 0) return x;
    ((value > 0) == rises ? high : low) = x;
    double next = x - value / slope;
    if (!(next > low && next < high)) next = 0.5 * (low + high);
    const double change = std::abs(next - x);
    x = next;
    if (change <= 2 * std::numeric_limits<double>::epsilon() * std::abs(x)) break;
  }
  return x;
}

}  // namespace arcslip
