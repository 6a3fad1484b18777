#pragma once

// Gauss' elimination in several matrices of one size at once: of small ones, one alone would be all overhead.

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "arcslip/types.hpp"

namespace arcslip::continuation {

/// Their entries side by side, column by column. Pivots are the largest entries of columns, each matrix's
/// own.
class BlocksSideBySide {
 public:
  static constexpr Index lanes = 4;

  /// At least as many columns as rows.
  BlocksSideBySide(Index rows, Index columns)
      : rows_(rows), columns_(columns), values_(static_cast<std::size_t>(rows * columns * lanes)) {}

  /// An entry of the first one, before that of the others.
  double* at(Index row, Index column) { return values_.data() + (column * rows_ + row) * lanes; }

  /// The first columns, as many as there are rows, from those behind them.
  void eliminate() {
    double inverse[lanes];
    double factor[lanes];
    for (Index k = 0; k < rows_; ++k) {
      exchange(k);
      const double* const column = at(k, k);
      for (Index l = 0; l < lanes; ++l) inverse[l] = 1 / column[l];
      for (Index j = k + 1; j < columns_; ++j) {
        double* __restrict const other = at(k, j);
        for (Index l = 0; l < lanes; ++l) factor[l] = other[l] * inverse[l];
        const double* __restrict const below = column;
        for (Index i = 1; i < rows_ - k; ++i) {
          for (Index l = 0; l < lanes; ++l) other[i * lanes + l] -= factor[l] * below[i * lanes + l];
        }
      }
    }
  }

  /// Then the last `count` unknowns by the right-hand sides in the columns behind, in their place.
  void solve_last(Index count) {
    for (Index j = rows_; j < columns_; ++j) {
      for (Index i = rows_; i-- > rows_ - count;) {
        double* const own = at(i, j);
        const double* const pivot = at(i, i);
        for (Index l = 0; l < lanes; ++l) own[l] /= pivot[l];
        for (Index r = rows_ - count; r < i; ++r) {
          double* const other = at(r, j);
          const double* const entry = at(r, i);
          for (Index l = 0; l < lanes; ++l) other[l] -= entry[l] * own[l];
        }
      }
    }
  }

 private:
  /// The row of each matrix that is to give pivot k comes there.
  void exchange(Index k) {
    double largest[lanes];
    double row[lanes];
    const double* entry = at(k, k);
    for (Index l = 0; l < lanes; ++l) largest[l] = std::abs(entry[l]);
    std::fill_n(row, lanes, static_cast<double>(k));
    for (Index i = k + 1; i < rows_; ++i) {
      entry += lanes;
      for (Index l = 0; l < lanes; ++l) {
        const double size = std::abs(entry[l]);
        row[l] = size > largest[l] ? static_cast<double>(i) : row[l];
        largest[l] = size > largest[l] ? size : largest[l];
      }
    }
    for (Index l = 0; l < lanes; ++l) {
      const auto best = static_cast<Index>(row[l]);
      if (best == k) continue;
      for (Index j = k; j < columns_; ++j) std::swap(at(k, j)[l], at(best, j)[l]);
    }
  }

  Index rows_;
  Index columns_;
  std::vector<double> values_;
};

}  // namespace arcslip::continuation
