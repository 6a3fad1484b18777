#pragma once

// Zeros of a function of an angle whose second derivative is bounded: cells that may hold more than one are
// halved until none is left.

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include "motion/bracketed_newton.hpp"

namespace arcslip {

/// A cell of angles and the function at its ends, nan where that is not known.
struct AngleCell {
  double low;
  double high;
  double at_low = std::numeric_limits<double>::quiet_NaN();
  double at_high = std::numeric_limits<double>::quiet_NaN();
};

/// Whether a function has no zero within `width` of a place, from its value and derivative there and the
/// bound of its second derivative.
inline bool keeps_from_zero(double value, double slope, double bound, double width) {
  return std::abs(value) > (std::abs(slope) + 0.5 * bound * width) * width;
}

/// Where the parabola through both ends of a cell and its middle, with the slope there, is zero, about; the
/// middle if that is outside.
inline double parabola_zero(const AngleCell& cell, double value, double slope) {
  const double middle = 0.5 * (cell.low + cell.high);
  const double width = 0.5 * (cell.high - cell.low);
  const double bend = 0.5 * (cell.at_low + cell.at_high - 2 * value) / (width * width);
  const double zero = middle - value / (slope - bend * value / slope);
  return zero > cell.low && zero < cell.high ? zero : middle;
}

/// Calls `take` with each angle of [low, high) of a cell <= 1 wide, in ascending order, at which the sign
/// changes, but pairs of them closer than 1e-8; a zero at the lower end of a cell counts as one. `at` gives
/// value and derivative at an angle, `bound` > 0 that of the second derivative.
template <class Function, class Take>
void isolate_zeros(const Function& at, double bound, const AngleCell& whole, const Take& take) {
  constexpr double narrow = 1e-8;
  std::array<AngleCell, 64> open;  // what is not searched, the leftmost last: halving 1 to 1e-8 leaves 27
  std::size_t count = 0;
  open[count++] = whole;
  while (count > 0) {
    AngleCell cell = open[--count];
    const double middle = 0.5 * (cell.low + cell.high);
    const double width = 0.5 * (cell.high - cell.low);
    const auto [value, slope] = at(middle);
    const bool passes = cell.at_low * cell.at_high <= 0;  // what bounds may tell otherwise by rounding
    if (!passes && keeps_from_zero(value, slope, bound, width)) continue;
    if (std::abs(slope) > bound * width || width < narrow) {  // one zero at most
      if (std::isnan(cell.at_low)) cell.at_low = at(cell.low).first;
      if (std::isnan(cell.at_high)) cell.at_high = at(cell.high).first;
      if (cell.at_low == 0) {
        take(cell.low);
      } else if (cell.at_low * cell.at_high < 0) {
        const double guess = parabola_zero(cell, value, slope);
        take(bracketed_newton(at, guess, cell.low, cell.high, cell.at_low < 0));
      }
      continue;
    }
    open[count++] = {middle, cell.high, value, cell.at_high};
    open[count++] = {cell.low, middle, cell.at_low, value};
  }
}

/// The same of [begin, begin + span), searched in `parts` cells.
template <class Function, class Take>
void isolate_zeros(const Function& at, double bound, double begin, double span, int parts, const Take& take) {
  for (int i = 0; i < parts; ++i)
    isolate_zeros(at, bound, {begin + i * span / parts, begin + (i + 1) * span / parts}, take);
}

}  // namespace arcslip
