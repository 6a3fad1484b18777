#include "arcslip/continuation/linear/blocks_side_by_side.hpp"

#include "arcslip/continuation/linear/row_scale.hpp"
#include "arcslip/wide.hpp"

namespace arcslip::continuation {

/// The row of each matrix that is to give pivot k comes there: another one where it is much better.
void BlocksSideBySide::exchange(Index k) {
  constexpr double enough = 0.5;  // of the largest entry
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
    const bool stays = std::abs(at(k, k)[l]) >= enough * largest[l];
    const auto best = stays ? k : static_cast<Index>(row[l]);
    exchanged_[static_cast<std::size_t>(k * lanes + l)] = best;
    if (best == k) continue;
    for (Index j = k; j < columns_; ++j) std::swap(at(k, j)[l], at(best, j)[l]);
  }
}

ARCSLIP_WIDE bool BlocksSideBySide::scale_rows(double* __restrict scale) {
  const Index count = (rows_ - staying_) * lanes;
  std::fill_n(scale, count, 0.0);
  for (Index j = 0; j < columns_; ++j) {
    const double* __restrict const column = at(0, j);
    for (Index i = 0; i < count; ++i) {
      const double size = std::abs(column[i]);
      scale[i] = size > scale[i] ? size : scale[i];
    }
  }
  if (std::any_of(scale, scale + count, [](double largest) { return largest == 0; })) return false;
  for (Index i = 0; i < count; ++i) scale[i] = scale_to_one(scale[i]);
  for (Index j = 0; j < columns_; ++j) {
    double* __restrict const column = at(0, j);
    for (Index i = 0; i < count; ++i) column[i] *= scale[i];
  }
  return true;
}

ARCSLIP_WIDE void BlocksSideBySide::eliminate() {
  double factor[lanes];
  for (Index k = 0; k < pivots_; ++k) {
    exchange(k);
    const double* const column = at(k, k);
    double* const inverse = inverses_.data() + k * lanes;
    for (Index l = 0; l < lanes; ++l) inverse[l] = 1 / column[l];
    for (Index j = k + 1; j < columns_; ++j) {
      double* const other = at(k, j);
      for (Index l = 0; l < lanes; ++l) factor[l] = other[l] * inverse[l];
      subtract(rows_ - k - 1, other + lanes, column + lanes, factor);
    }
  }
}

ARCSLIP_WIDE double BlocksSideBySide::largest() const {
  double largest[lanes] = {};
  for (Index j = 0; j < columns_; ++j) {
    const double* const column = at(0, j);
    const Index end = std::min(j, pivots_);
    for (Index i = 0; i < end; ++i) {
      for (Index l = 0; l < lanes; ++l) {
        const double size = std::abs(column[i * lanes + l]);
        largest[l] = size > largest[l] ? size : largest[l];
      }
    }
  }
  return *std::max_element(largest, largest + lanes);
}

ARCSLIP_WIDE double BlocksSideBySide::largest_multiple() const {
  double largest[lanes] = {};
  for (Index k = 0; k < pivots_; ++k) {
    const double* const column = at(0, k);
    for (Index i = rows_ - staying_; i < rows_; ++i) {
      for (Index l = 0; l < lanes; ++l) {
        const double size = std::abs(column[i * lanes + l] * inverse(k)[l]);
        largest[l] = size > largest[l] ? size : largest[l];
      }
    }
  }
  return *std::max_element(largest, largest + lanes);
}

ARCSLIP_WIDE void BlocksSideBySide::forward(double* y) const {
  double factor[lanes];
  for (Index k = 0; k < pivots_; ++k) {
    exchange(k, y);
    double* const own = y + k * lanes;
    for (Index l = 0; l < lanes; ++l) factor[l] = own[l] * inverse(k)[l];
    subtract(rows_ - k - 1, own + lanes, at(k, k) + lanes, factor);
  }
}

ARCSLIP_WIDE void BlocksSideBySide::back(double* y, const double* behind) const {
  for (Index j = pivots_; j < columns_; ++j, behind += lanes) subtract(pivots_, y, at(0, j), behind);
  for (Index k = pivots_; k-- > 0;) {
    double* const own = y + k * lanes;
    multiply(own, inverse(k));
    subtract(k, y, at(0, k), own);
  }
}

}  // namespace arcslip::continuation
