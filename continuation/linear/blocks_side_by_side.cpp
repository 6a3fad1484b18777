#include "arcslip/continuation/linear/blocks_side_by_side.hpp"

namespace arcslip::continuation {

/// The row of each matrix that is to give pivot k comes there.
void BlocksSideBySide::exchange(Index k) {
  double largest[lanes];
  double row[lanes];
  const double* entry = at(k, k);
  for (Index l = 0; l < lanes; ++l) largest[l] = std::abs(entry[l]);
  for (Index l = 0; l < lanes; ++l) row[l] = static_cast<double>(k);
  for (Index i = k + 1; i < rows_ - staying_; ++i) {
    entry += lanes;
    for (Index l = 0; l < lanes; ++l) {
      const double size = std::abs(entry[l]);
      row[l] = size > largest[l] ? static_cast<double>(i) : row[l];
      largest[l] = size > largest[l] ? size : largest[l];
    }
  }
  for (Index l = 0; l < lanes; ++l) {
    const auto best = static_cast<Index>(row[l]);
    exchanged_[static_cast<std::size_t>(k * lanes + l)] = best;
    if (best == k) continue;
    for (Index j = k; j < columns_; ++j) std::swap(at(k, j)[l], at(best, j)[l]);
  }
}

void BlocksSideBySide::eliminate() {
  double inverse[lanes];
  double factor[lanes];
  for (Index k = 0; k < pivots_; ++k) {
    exchange(k);
    const double* const column = at(k, k);
    for (Index l = 0; l < lanes; ++l) inverse[l] = 1 / column[l];
    for (Index j = k + 1; j < columns_; ++j) {
      double* const other = at(k, j);
      for (Index l = 0; l < lanes; ++l) factor[l] = other[l] * inverse[l];
      subtract(rows_ - k - 1, other + lanes, column + lanes, factor);
    }
  }
}

}  // namespace arcslip::continuation
