#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "arcslip/continuation/linear/bordered_solver.hpp"
#include "arcslip/continuation/linear/front_plan.hpp"
#include "arcslip/continuation/linear/row_scale.hpp"
#include "arcslip/continuation/linear/sparse_factors.hpp"

namespace arcslip::continuation {
namespace {

constexpr int panel = 4;  // columns that are eliminated from the others at a time

std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// x <- x - l u
inline void subtract(double* __restrict x, const double* __restrict l, double u, int length) {
  for (int i = 0; i < length; ++i) x[i] -= l[i] * u;
}

/// x <- x - sum_k l_k u_k of a panel's columns l, which stand one `stride` apart: its own rows first, below a
/// diagonal of 1. The length is a multiple of 4: short loops that may end anywhere are all overhead.
inline void subtract(double* __restrict x, const double* __restrict l, std::ptrdiff_t stride, int length) {
  const double* __restrict b = l + stride;
  const double* __restrict c = b + stride;
  const double* __restrict d = c + stride;
  const double u = x[0];
  const double v = x[1] - l[1] * u;
  const double w = x[2] - l[2] * u - b[2] * v;
  const double z = x[3] - l[3] * u - b[3] * v - c[3] * w;
  x[1] = v;
  x[2] = w;
  x[3] = z;
  for (int i = panel; i < length; i += 4) {
    for (int k = i; k < i + 4; ++k) x[k] -= (l[k] * u + b[k] * v) + (c[k] * w + d[k] * z);
  }
}

class FrontalFactors final : public SparseFactors {
 public:
  explicit FrontalFactors(FrontPlan plan)
      : fronts_(std::move(plan.fronts)),
        row_order_(std::move(plan.row_order)),
        column_order_(std::move(plan.column_order)),
        work_(static_cast<Index>(row_order_.size())) {
    std::vector<char> seen(row_order_.size());
    orders_sign_ = permutation_sign(row_order_.data(), seen) * permutation_sign(column_order_.data(), seen);
    const Front& last = fronts_.back();
    values_.resize(static_cast<std::size_t>(last.values) + at(last.stride) * at(last.columns));
  }

  double factor(const SparseMatrix& matrix) override {
    if (!find_row_scale(matrix, row_scale_)) return 0;
    double sign = orders_sign_;
    growth_ = 0;
    for (std::size_t f = 0; f < fronts_.size() && sign != 0; ++f) {
      assemble(matrix, f);
      sign *= eliminate(fronts_[f]);
    }
    return sign;
  }

  void multiply_determinant(LogProduct& product) const override {
    for (const Front& front : fronts_) {
      const double* a = values_.data() + front.values;
      for (int k = 0; k < front.pivots; ++k) product *= a[static_cast<std::ptrdiff_t>(k) * front.stride + k];
    }
    for (const double scale : row_scale_) product /= scale;
  }

  double growth() const override { return growth_; }

  void solve(Vector& x) override {
    for (Index i = 0; i < x.size(); ++i) {
      const int row = row_order_[static_cast<std::size_t>(i)];
      work_(i) = x(row) * row_scale_(row);
    }
    double* y = work_.data();
    double* staying = y + work_.size();
    for (const Front& front : fronts_) {
      const int stay = front.height - front.rows;
      double* own = y + front.first;
      const double* l = values_.data() + front.values;
      for (int k = 0; k < front.pivots; ++k) std::swap(own[k], own[front.exchanged[at(k)]]);
      for (int k = 0; k < front.pivots; ++k, l += front.stride) {
        subtract(own + k + 1, l + k + 1, own[k], front.rows - k - 1);
        subtract(staying - stay, l + front.rows, own[k], stay);
      }
    }
    for (auto front = fronts_.rbegin(); front != fronts_.rend(); ++front) {
      double* own = y + front->first;
      const double* u = values_.data() + front->values;
      const double* kept = u + static_cast<std::ptrdiff_t>(front->pivots) * front->stride;
      for (const int position : front->kept) {
        subtract(own, kept, y[position], front->pivots);
        kept += front->stride;
      }
      for (int k = front->pivots; k-- > 0;) {
        const double* column = u + static_cast<std::ptrdiff_t>(k) * front->stride;
        own[k] /= column[k];
        subtract(own, column, own[k], k);
      }
    }
    for (Index i = 0; i < x.size(); ++i) x(column_order_[static_cast<std::size_t>(i)]) = work_(i);
  }

  void solve_transposed(Vector& x) override {
    for (Index i = 0; i < x.size(); ++i) work_(i) = x(column_order_[static_cast<std::size_t>(i)]);
    double* y = work_.data();
    double* staying = y + work_.size();
    for (const Front& front : fronts_) {
      double* own = y + front.first;
      const double* u = values_.data() + front.values;
      for (int k = 0; k < front.pivots; ++k, u += front.stride) {
        for (int i = 0; i < k; ++i) own[k] -= u[i] * own[i];
        own[k] /= u[k];
      }
      for (const int position : front.kept) {
        for (int i = 0; i < front.pivots; ++i) y[position] -= u[i] * own[i];
        u += front.stride;
      }
    }
    for (auto front = fronts_.rbegin(); front != fronts_.rend(); ++front) {
      const int stay = front->height - front->rows;
      double* own = y + front->first;
      for (int k = front->pivots; k-- > 0;) {
        const double* l = values_.data() + front->values + static_cast<std::ptrdiff_t>(k) * front->stride;
        for (int i = k + 1; i < front->rows; ++i) own[k] -= l[i] * own[i];
        for (int i = 0; i < stay; ++i) own[k] -= l[front->rows + i] * (staying - stay)[i];
      }
      for (int k = front->pivots; k-- > 0;) std::swap(own[k], own[front->exchanged[at(k)]]);
    }
    for (Index i = 0; i < x.size(); ++i) {
      const int row = row_order_[static_cast<std::size_t>(i)];
      x(row) = work_(i) * row_scale_(row);
    }
  }

 private:
  /// What the front before has left, and what enters.
  void assemble(const SparseMatrix& matrix, std::size_t number) {
    const Front& front = fronts_[number];
    double* a = values_.data() + front.values;
    std::fill_n(a, static_cast<std::ptrdiff_t>(front.stride) * front.columns, 0.0);
    if (number > 0) {
      const Front& before = fronts_[number - 1];
      const double* left = values_.data() + before.values +
                           static_cast<std::ptrdiff_t>(before.pivots) * before.stride + before.pivots;
      const int rows = before.rows - before.pivots;
      const int stay = before.height - before.rows;
      const int own_stay = front.first + front.pivots == work_.size() ? front.rows - stay : front.rows;
      for (const int place : front.carried) {
        double* column = a + static_cast<std::ptrdiff_t>(place) * front.stride;
        std::copy_n(left, rows, column);
        std::copy_n(left + rows, stay, column + own_stay);
        left += before.stride;
      }
    }
    const double* values = matrix.valuePtr();
    const int* rows = matrix.innerIndexPtr();
    for (std::size_t k = 0; k < front.entries.size(); ++k) {
      const int entry = front.entries[k];
      a[front.places[k]] = values[entry] * row_scale_(rows[entry]);
    }
  }

  /// The sign of the pivots and of the exchanges of rows.
  double eliminate(Front& front) {
    double* a = values_.data() + front.values;
    const std::ptrdiff_t stride = front.stride;
    double sign = 1;
    double growth = 0;
    for (int from = 0; from < front.pivots; from += panel) {
      const int to = std::min(from + panel, front.pivots);
      for (int k = from; k < to; ++k) sign *= take_pivot(front, k, to);
      if (sign == 0) return 0;
      for (int j = to; j < front.columns; ++j) {
        double* x = a + j * stride;
        for (int k = from; k < to; ++k) std::swap(x[k], x[front.exchanged[at(k)]]);
        if (to - from == panel) {
          subtract(x + from, a + from * stride + from, stride, front.stride - from);
        } else {
          for (int k = from; k < to; ++k)
            subtract(x + k + 1, a + k * stride + k + 1, x[k], front.height - k - 1);
        }
        for (int k = from; k < to; ++k) growth = std::max(growth, std::abs(x[k]));
      }
    }
    growth_ = std::max(growth_, growth);
    return sign;
  }

  /// Eliminates a column from those up to `to`.
  double take_pivot(Front& front, int k, int to) {
    double* a = values_.data() + front.values;
    const std::ptrdiff_t stride = front.stride;
    double* column = a + k * stride;
    int best = k;
    for (int i = k + 1; i < front.rows; ++i) {
      if (std::abs(column[i]) > std::abs(column[best])) best = i;
    }
    front.exchanged[at(k)] = best;
    const double pivot = column[best];
    if (pivot == 0 || !std::isfinite(pivot)) return 0;
    for (int j = 0; j <= k; ++j) std::swap(a[j * stride + k], a[j * stride + best]);
    const double inverse = 1 / pivot;
    for (int i = k + 1; i < front.height; ++i) column[i] *= inverse;
    for (int i = front.rows; i < front.height; ++i) growth_ = std::max(growth_, std::abs(column[i]));
    for (int j = k + 1; j < to; ++j) {
      double* x = a + j * stride;
      std::swap(x[k], x[best]);
      subtract(x + k + 1, column + k + 1, x[k], front.height - k - 1);
    }
    return (best == k) == (pivot > 0) ? 1 : -1;
  }

  std::vector<Front> fronts_;
  std::vector<int> row_order_;
  std::vector<int> column_order_;
  double orders_sign_ = 1;
  double growth_ = 0;
  std::vector<double> values_;
  Vector row_scale_;
  Vector work_;
};

}  // namespace

std::unique_ptr<SparseFactors> make_frontal_factors(const SparseMatrix& pattern, Index borders, double most) {
  FrontPlan plan = plan_fronts(pattern, borders, most);
  if (plan.fronts.empty()) return nullptr;
  return std::make_unique<FrontalFactors>(std::move(plan));
}

}  // namespace arcslip::continuation
