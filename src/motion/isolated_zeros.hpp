#pragma once

// Zeros of a function of an angle whose second derivative is bounded: cells that may hold more than one are
// halved until none is left.

#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#include "arcslip/types.hpp"
#include "motion/bracketed_newton.hpp"

namespace arcslip {

/// Calls `take` with each angle of [begin, begin + span), in ascending order, at which the sign changes, but
/// pairs of them closer than 1e-8; a zero at the lower end of a cell counts as one. `at` gives value and
/// derivative at an angle, `bound` > 0 that of the second derivative. The search begins with `parts` <= 8
/// cells, of span/parts <= 1.
template <class Function, class Take>
void isolate_zeros(const Function& at, double bound, double begin, double span, int parts, const Take& take) {
  constexpr double narrow = 1e-8;
  struct Cell {
    double low;
    double high;
  };
  std::array<Cell, 64> open;  // what is not searched, the leftmost last: halving 1 down to 1e-8 leaves 27
  std::size_t count = 0;
  for (int i = parts; i-- > 0;) open[count++] = {begin + i * span / parts, begin + (i + 1) * span / parts};
  while (count > 0) {
    const Cell cell = open[--count];
    const double middle = 0.5 * (cell.low + cell.high);
    const double width = 0.5 * (cell.high - cell.low);
    const auto [value, slope] = at(middle);
    if (std::abs(value) > (std::abs(slope) + 0.5 * bound * width) * width) continue;
    if (std::abs(slope) > bound * width || width < narrow) {  // one zero at most
      const double low = at(cell.low).first;
      if (low == 0) {
        take(cell.low);
      } else if (low * at(cell.high).first < 0) {
        take(bracketed_newton(at, middle, cell.low, cell.high, low < 0));
      }
      continue;
    }
    open[count++] = {middle, cell.high};
    open[count++] = {cell.low, middle};
  }
}

}  // namespace arcslip
