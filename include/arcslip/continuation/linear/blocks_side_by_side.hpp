#pragma once

// Gauss' elimination in several matrices of one size at once: of small ones, one alone would be all overhead.

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "arcslip/types.hpp"

namespace arcslip::continuation {

/// Their entries side by side, column by column. The first columns, `pivots` of them, are eliminated from all
/// others, by rows which stand before the last `staying` ones. Pivots are at
/// least half as large as any entry of their columns, each matrix's own rows. Vectors have their entries side
/// by side as well.
class BlocksSideBySide {
 public:
  static constexpr Index lanes = 4;

  /// pivots <= rows - staying, pivots <= columns.
  BlocksSideBySide(Index rows, Index columns, Index pivots, Index staying = 0)
      : rows_(rows),
        columns_(columns),
        pivots_(pivots),
        staying_(staying),
        values_(static_cast<std::size_t>(rows * columns * lanes)),
        inverses_(static_cast<std::size_t>(pivots * lanes)),
        exchanged_(static_cast<std::size_t>(pivots * lanes)) {}

  /// An entry of the first one, before that of the others.
  double* at(Index row, Index column) { return values_.data() + (column * rows_ + row) * lanes; }
  const double* at(Index row, Index column) const { return values_.data() + (column * rows_ + row) * lanes; }

  /// Multiplies the rows of each matrix, but those that stay, by powers of two that make their largest
  /// entries 1 to 2, which go to `scale` side by side. False if a row is zero.
  [[nodiscard]] bool scale_rows(double* scale);

  /// Leaves multiples of the pivots' columns below these, and in the rows of pivots and behind the columns
  /// what the elimination has made.
  void eliminate();

  /// Then the last `count` unknowns by the right-hand sides in the columns behind, in their place.
  void solve_last(Index count) {
    for (Index j = pivots_; j < columns_; ++j) {
      for (Index i = pivots_; i-- > pivots_ - count;) {
        double* const own = at(i, j);
        multiply(own, inverse(i));
        const Index above = i - (pivots_ - count);
        subtract(above, at(i - above, j), at(i - above, i), own);
      }
    }
  }

  /// The same elimination in a vector of all rows.
  void forward(double* y) const;

  /// Its first entries, as many as there are pivots, become the unknowns, where the others are `behind`.
  void back(double* y, const double* behind) const;

  /// Of the transposed matrices: the first entries become those of the rows of pivots, which are taken out of
  /// the entries `behind`.
  void forward_transposed(double* y, double* behind) const {
    for (Index k = 0; k < pivots_; ++k) {
      double* const own = y + k * lanes;
      subtract_products(k, own, at(0, k), y);
      multiply(own, inverse(k));
    }
    for (Index j = pivots_; j < columns_; ++j, behind += lanes)
      subtract_products(pivots_, behind, at(0, j), y);
  }

  /// Then with those of the other rows behind these: all, in the rows' order.
  void back_transposed(double* y) const {
    for (Index k = pivots_; k-- > 0;) {
      double sum[lanes] = {};
      subtract_products(rows_ - k - 1, sum, at(k, k) + lanes, y + (k + 1) * lanes);
      for (Index l = 0; l < lanes; ++l) y[k * lanes + l] += sum[l] * inverse(k)[l];
      exchange(k, y);
    }
  }

  /// Of one matrix: of its pivots and of the exchanges of rows.
  double sign(Index lane) const {
    double sign = 1;
    for (Index k = 0; k < pivots_; ++k) {
      const bool stays = exchanged_[static_cast<std::size_t>(k * lanes + lane)] == k;
      if (stays != (at(k, k)[lane] > 0)) sign = -sign;
    }
    return sign;
  }

  /// The largest entry that the elimination has left in the rows of pivots.
  double largest() const;

  /// The largest multiple of a row of pivots that the elimination has subtracted from a row that stays.
  double largest_multiple() const;

 private:
  void exchange(Index k);

  /// Of the pivots.
  const double* inverse(Index k) const { return inverses_.data() + k * lanes; }

  static void multiply(double* x, const double* factor) {
    for (Index l = 0; l < lanes; ++l) x[l] *= factor[l];
  }

  /// x_i <- x_i - a_i b
  static void subtract(Index count, double* __restrict x, const double* __restrict a, const double* b) {
    double factor[lanes];
    for (Index l = 0; l < lanes; ++l) factor[l] = b[l];
    for (Index i = 0; i < count; ++i) {
      for (Index l = 0; l < lanes; ++l) x[i * lanes + l] -= a[i * lanes + l] * factor[l];
    }
  }

  /// x <- x - sum_i a_i b_i
  static void subtract_products(Index count, double* x, const double* a, const double* b) {
    double rest[lanes];
    for (Index l = 0; l < lanes; ++l) rest[l] = x[l];
    for (Index i = 0; i < count; ++i) {
      for (Index l = 0; l < lanes; ++l) rest[l] -= a[i * lanes + l] * b[i * lanes + l];
    }
    for (Index l = 0; l < lanes; ++l) x[l] = rest[l];
  }

  void exchange(Index k, double* y) const {
    for (Index l = 0; l < lanes; ++l) {
      const Index best = exchanged_[static_cast<std::size_t>(k * lanes + l)];
      std::swap(y[k * lanes + l], y[best * lanes + l]);
    }
  }

  Index rows_;
  Index columns_;
  Index pivots_;
  Index staying_;
  std::vector<double> values_;
  std::vector<double> inverses_;
  std::vector<Index> exchanged_;  // the row that came to each pivot's place
};

}  // namespace arcslip::continuation
