#include "arcslip/continuation/linear/dense_bordered_solver.hpp"

#include <cmath>
#include <utility>

extern "C" {  // of LAPACK, which ships no header
void dgetrf_(const int* rows, const int* columns, double* a, const int* stride, int* pivots, int* info);
void dgetrs_(const char* transposed, const int* size, const int* sides, const double* a, const int* stride,
             const int* pivots, double* b, const int* stride_of_b, int* info);
}

namespace arcslip::continuation {
namespace {

double sign_of(double value) { return static_cast<double>(value > 0) - static_cast<double>(value < 0); }

/// That of the product of the pivots; 0 of what is no number.
double sign_of_pivots(const Matrix& factors) {
  double sign = 1;
  for (const double pivot : factors.diagonal()) sign *= std::isfinite(pivot) ? sign_of(pivot) : 0;
  return sign;
}

/// Solves with the factors of `dgetrf_`, or with the transposed.
void solve_large(const Matrix& factors, const std::vector<int>& exchanges, char transposed, Vector& x) {
  const auto size = static_cast<int>(x.size());
  const int one = 1;
  int info = 0;
  dgetrs_(&transposed, &size, &one, factors.data(), &size, exchanges.data(), x.data(), &size, &info);
}

}  // namespace

DenseBorderedSolver::DenseBorderedSolver(Index size, Index borders)
    : BorderedSolver(size, borders),
      matrix_(Matrix::Zero(size + borders, size + borders)),
      factors_(matrix_),
      pivots_(static_cast<std::size_t>(size + borders)),
      exchanges_(pivots_.size()),
      lu_(small() || large() ? 1 : size + borders),
      solution_(size + borders),
      seen_(small() ? 0 : static_cast<std::size_t>(size + borders)) {}

void DenseBorderedSolver::set_jacobian(const Matrix& jacobian, const Vector& column_scale) {
  const Index n = size();
  for (Index j = 0; j < n; ++j) {
    for (Index i = 0; i < n; ++i) matrix_(i, j) = jacobian(i, j) * column_scale(j);
  }
}

void DenseBorderedSolver::set_borders() {
  const Index n = size();
  for (Index k = 0; k < borders(); ++k) {
    for (Index i = 0; i < n; ++i) {
      matrix_(i, n + k) = columns()(i, k);
      matrix_(n + k, i) = rows()(k, i);
    }
    for (Index i = 0; i < borders(); ++i) matrix_(n + i, n + k) = corner()(i, k);
  }
}

double DenseBorderedSolver::factor() {
  set_borders();
  if (small()) return factor_small();
  if (large()) return factor_large();
  lu_.compute(matrix_);
  return permutation_sign(lu_.permutationP().indices().data(), seen_) * sign_of_pivots(lu_.matrixLU());
}

void DenseBorderedSolver::multiply_determinant(LogProduct& product) const {
  for (const double pivot : small() || large() ? factors_.diagonal() : lu_.matrixLU().diagonal())
    product *= pivot;
}

double DenseBorderedSolver::factor_large() {
  const auto n = static_cast<int>(matrix_.rows());
  int info = 0;
  factors_ = matrix_;
  dgetrf_(&n, &n, factors_.data(), &n, exchanges_.data(), &info);
  double sign = sign_of_pivots(factors_);
  for (int i = 0; i < n; ++i) {
    if (exchanges_[static_cast<std::size_t>(i)] != i + 1) sign = -sign;
  }
  return sign;
}

/// Column by column, from which the earlier columns are eliminated four at a time.
double DenseBorderedSolver::factor_small() {
  const Index n = matrix_.rows();
  factors_ = matrix_;
  double sign = 1;
  for (Index j = 0; j < n; ++j) {
    double* const x = factors_.col(j).data();
    for (Index k = 0; k < j; ++k) std::swap(x[k], x[pivots_[static_cast<std::size_t>(k)]]);
    eliminate(j);
    Index best = j;
    for (Index i = j + 1; i < n; ++i) {
      if (std::abs(x[i]) > std::abs(x[best])) best = i;
    }
    pivots_[static_cast<std::size_t>(j)] = best;
    if (best != j) {
      for (Index c = 0; c <= j; ++c) std::swap(factors_(j, c), factors_(best, c));
      sign = -sign;
    }
    const double pivot = x[j];
    if (pivot == 0 || !std::isfinite(pivot)) return 0;
    sign *= sign_of(pivot);
    for (Index i = j + 1; i < n; ++i) x[i] /= pivot;
  }
  return sign;
}

void DenseBorderedSolver::eliminate(Index j) {
  const Index n = matrix_.rows();
  double* const x = factors_.col(j).data();
  Index k = 0;
  for (; k + 4 <= j; k += 4) {
    const double* const a = factors_.col(k).data();
    const double* const b = a + n;
    const double* const c = b + n;
    const double* const d = c + n;
    const double by_a = x[k];
    const double by_b = x[k + 1] -= a[k + 1] * by_a;
    const double by_c = x[k + 2] -= a[k + 2] * by_a + b[k + 2] * by_b;
    const double by_d = x[k + 3] -= a[k + 3] * by_a + b[k + 3] * by_b + c[k + 3] * by_c;
    for (Index i = k + 4; i < n; ++i) x[i] -= a[i] * by_a + b[i] * by_b + c[i] * by_c + d[i] * by_d;
  }
  for (; k < j; ++k) {
    const double* const a = factors_.col(k).data();
    for (Index i = k + 1; i < n; ++i) x[i] -= a[i] * x[k];
  }
}

void DenseBorderedSolver::solve(Vector& right_hand_side) {
  Vector& x = right_hand_side;
  if (large()) return solve_large(factors_, exchanges_, 'N', x);
  if (!small()) {
    solution_.noalias() = lu_.permutationP() * x;
    lu_.matrixLU().triangularView<Eigen::UnitLower>().solveInPlace(solution_);
    lu_.matrixLU().triangularView<Eigen::Upper>().solveInPlace(solution_);
    x = solution_;
    return;
  }
  const Index n = x.size();
  for (Index k = 0; k < n; ++k) std::swap(x(k), x(pivots_[static_cast<std::size_t>(k)]));
  for (Index k = 0; k < n; ++k) {
    for (Index i = k + 1; i < n; ++i) x(i) -= factors_(i, k) * x(k);
  }
  for (Index k = n - 1; k >= 0; --k) {
    x(k) /= factors_(k, k);
    for (Index i = 0; i < k; ++i) x(i) -= factors_(i, k) * x(k);
  }
}

void DenseBorderedSolver::solve_transposed(Vector& right_hand_side) {
  Vector& x = right_hand_side;
  if (large()) return solve_large(factors_, exchanges_, 'T', x);
  const auto& factors = small() ? factors_ : lu_.matrixLU();
  factors.triangularView<Eigen::Upper>().transpose().solveInPlace(x);
  factors.triangularView<Eigen::UnitLower>().transpose().solveInPlace(x);
  if (small()) {
    for (Index k = x.size() - 1; k >= 0; --k) std::swap(x(k), x(pivots_[static_cast<std::size_t>(k)]));
  } else {
    solution_.noalias() = lu_.permutationP().inverse() * x;
    x = solution_;
  }
}

}  // namespace arcslip::continuation
