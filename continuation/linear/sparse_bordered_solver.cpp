#include "arcslip/continuation/linear/sparse_bordered_solver.hpp"

#include <amd.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <new>
#include <stdexcept>
#include <vector>

namespace arcslip::continuation {
namespace {

constexpr double last_weight =
    1e-6;                         // of the largest entry of a row for the end where that of others is 1 to 2
constexpr double dense_gain = 6;  // in multiplications a second, of fronts over single entries
constexpr double little_growth = 1e3;  // of entries in fronts: these digits are not missed
constexpr double exact_enough = 1e-8;  // of a correction: its square is below rounding
constexpr int most_refinements = 4;

/// The power of two that scales x > 0 to between 1 and 2, by its bits; calls would take a twentieth of all.
double scale_to_one(double x) {
  constexpr int fraction = 52;
  constexpr std::uint64_t most = 2046;  // exponents, from 1
  const std::uint64_t exponent = std::bit_cast<std::uint64_t>(x) >> fraction;
  if (exponent < 1 || exponent >= most) return std::ldexp(1.0, -std::ilogb(x));
  return std::bit_cast<double>((most - exponent) << fraction);
}

}  // namespace

SparseBorderedSolver::SparseBorderedSolver(Index size, Index borders)
    : BorderedSolver(size, borders),
      largest_(size),
      row_scale_(size + borders),
      right_hand_side_(size + borders),
      solution_(size + borders),
      residual_(size + borders) {}

bool SparseBorderedSolver::same_pattern(const SparseMatrix& jacobian) const {
  if (matrix_.rows() == 0) return false;
  const int extra = static_cast<int>(borders());
  for (Index j = 0; j < size(); ++j) {
    const int* begin = jacobian.innerIndexPtr() + jacobian.outerIndexPtr()[j];
    const int* end = jacobian.innerIndexPtr() + jacobian.outerIndexPtr()[j + 1];
    const int* ours = matrix_.innerIndexPtr() + matrix_.outerIndexPtr()[j];
    const int count = matrix_.outerIndexPtr()[j + 1] - matrix_.outerIndexPtr()[j] - extra;
    if (end - begin != count || !std::equal(begin, end, ours)) return false;
  }
  return true;
}

void SparseBorderedSolver::set_pattern(const SparseMatrix& jacobian) {
  const Index n = size();
  const Index rows = n + borders();
  matrix_.resize(rows, rows);
  matrix_.reserve(jacobian.nonZeros() + (rows + n) * borders());
  for (Index j = 0; j < rows; ++j) {
    matrix_.startVec(j);
    if (j < n) {
      for (SparseMatrix::InnerIterator entry(jacobian, j); entry; ++entry) {
        matrix_.insertBack(entry.row(), j) = 0;
      }
    }
    for (Index i = j < n ? n : 0; i < rows; ++i) matrix_.insertBack(i, j) = 0;
  }
  matrix_.finalize();
  scaled_ = matrix_;

  order_.resize(static_cast<std::size_t>(rows));
  double info[AMD_INFO];
  const int status = amd_order(static_cast<int>(n), jacobian.outerIndexPtr(), jacobian.innerIndexPtr(),
                               order_.data(), nullptr, info);
  if (status == AMD_OUT_OF_MEMORY) throw std::bad_alloc();
  if (status < 0) throw std::invalid_argument("set_jacobian: the sparse Jacobian is not a valid matrix");
  for (Index i = n; i < rows; ++i) order_[static_cast<std::size_t>(i)] = static_cast<int>(i);
  find_last_rows(jacobian);
  dense_ = make_alike_factors(matrix_, borders());
  if (dense_ == nullptr)
    dense_ = make_frontal_factors(matrix_, borders(), dense_gain * info[AMD_NMULTSUBS_LU]);
  klu_.reset();
}

/// Those of the borders, and those which AMD sets aside for the end as it takes them for full.
void SparseBorderedSolver::find_last_rows(const SparseMatrix& jacobian) {
  const double most = std::max(16.0, AMD_DEFAULT_DENSE * std::sqrt(static_cast<double>(size())));
  std::vector<int> count(static_cast<std::size_t>(size()), 0);
  for (Index k = 0; k < jacobian.nonZeros(); ++k)
    ++count[static_cast<std::size_t>(jacobian.innerIndexPtr()[k])];
  last_rows_.clear();
  for (Index i = 0; i < size() + borders(); ++i) {
    if (i >= size() || count[static_cast<std::size_t>(i)] > most) last_rows_.push_back(i);
  }
}

void SparseBorderedSolver::set_jacobian(const SparseMatrix& jacobian, const Vector& column_scale) {
  if (!jacobian.isCompressed() || jacobian.rows() != size() || jacobian.cols() != size()) {
    throw std::invalid_argument("set_jacobian: a compressed matrix of the solver's size is needed");
  }
  if (!same_pattern(jacobian)) set_pattern(jacobian);
  largest_.setZero();
  double* __restrict const largest = largest_.data();
  for (Index j = 0; j < size(); ++j) {
    const int begin = jacobian.outerIndexPtr()[j];
    const int count = jacobian.outerIndexPtr()[j + 1] - begin;
    const double* __restrict const values = jacobian.valuePtr() + begin;
    const int* __restrict const rows = jacobian.innerIndexPtr() + begin;
    double* __restrict const ours = matrix_.valuePtr() + matrix_.outerIndexPtr()[j];
    const double scale = column_scale(j);
    for (int k = 0; k < count; ++k) {
      ours[k] = values[k] * scale;
      largest[rows[k]] = std::max(largest[rows[k]], std::abs(ours[k]));
    }
  }
}

void SparseBorderedSolver::set_borders() {
  for (Index j = 0; j < matrix_.cols(); ++j) {
    double* end = matrix_.valuePtr() + matrix_.outerIndexPtr()[j + 1];
    if (j < size()) {
      for (Index k = 0; k < borders(); ++k) end[k - borders()] = rows()(k, j);
    } else {
      const Index k = j - size();
      std::copy_n(corner().data() + k * borders(), borders(), end - borders());
      std::copy_n(columns().data() + k * size(), size(), end - borders() - size());
    }
  }
}

/// Powers of two, exact. False if a row is zero.
bool SparseBorderedSolver::scale_rows(double weight_of_last) {
  row_scale_.head(size()) = largest_;
  for (Index k = 0; k < borders(); ++k) {
    row_scale_.head(size()) = row_scale_.head(size()).cwiseMax(columns().col(k).cwiseAbs());
    row_scale_(size() + k) =
        std::max(rows().row(k).lpNorm<Eigen::Infinity>(), corner().row(k).lpNorm<Eigen::Infinity>());
  }
  if (!(row_scale_.minCoeff() > 0)) return false;
  for (double& scale : row_scale_) scale = scale_to_one(scale);
  for (const Index row : last_rows_) row_scale_(row) *= weight_of_last;
  const double* __restrict const values = matrix_.valuePtr();
  const int* __restrict const rows = matrix_.innerIndexPtr();
  const Index count = matrix_.nonZeros();
  const double* __restrict const scales = row_scale_.data();
  double* __restrict const scaled = scaled_.valuePtr();
  for (Index k = 0; k < count; ++k) scaled[k] = values[k] * scales[rows[k]];
  return true;
}

/// Where entries grow in fronts beyond what refinement makes good, by single entries, if they grow less
/// there.
double SparseBorderedSolver::factor() {
  if (matrix_.rows() == 0) return 0;
  set_borders();
  if (dense_ == nullptr) return factor_by_entries();
  if (!scale_rows(1)) return 0;
  factors_ = dense_.get();
  const double sign = dense_->factor(scaled_);
  if (sign != 0 && dense_->growth() < worst_growth) return sign;
  const double by_entries = factor_by_entries();
  if (sign == 0 || (by_entries != 0 && klu_->growth() < dense_->growth())) return by_entries;
  factors_ = dense_.get();
  return scale_rows(1) ? sign : 0;
}

double SparseBorderedSolver::factor_by_entries() {
  if (!scale_rows(last_weight)) return 0;
  if (klu_ == nullptr) klu_ = make_klu_factors(scaled_, order_);
  factors_ = klu_.get();
  return klu_->factor(scaled_);
}

void SparseBorderedSolver::multiply_determinant(LogProduct& product) const {
  factors_->multiply_determinant(product);
  for (const double scale : row_scale_) product /= scale;
}

/// Solves for right_hand_side_ with the scaled matrix, into solution_. The corrections of a refinement shrink
/// by one factor, so that the first tells whether it is enough.
void SparseBorderedSolver::solve_refined(bool transposed) {
  const auto solve_once = [&](Vector& x) { transposed ? factors_->solve_transposed(x) : factors_->solve(x); };
  // The unknowns of the transposed system are those of `solution_` times the rows' scale.
  const auto size_of = [&](const Vector& x) {
    return transposed ? x.cwiseProduct(row_scale_).lpNorm<Eigen::Infinity>() : x.lpNorm<Eigen::Infinity>();
  };
  solution_ = right_hand_side_;
  solve_once(solution_);
  if (factors_ == dense_.get() && factors_->growth() < little_growth) return;
  double last = size_of(solution_);
  for (int i = 0; i < most_refinements; ++i) {
    residual_ = right_hand_side_;
    if (transposed) {
      residual_.noalias() -= scaled_.transpose() * solution_;
    } else {
      residual_.noalias() -= scaled_ * solution_;
    }
    solve_once(residual_);
    const double length = size_of(residual_);
    if (!(length < 0.5 * last)) return;
    solution_ += residual_;
    if (length <= exact_enough * size_of(solution_)) return;
    last = length;
  }
}

void SparseBorderedSolver::solve(Vector& right_hand_side) {
  right_hand_side_ = right_hand_side.cwiseProduct(row_scale_);
  solve_refined(false);
  right_hand_side = solution_;
}

void SparseBorderedSolver::solve_transposed(Vector& right_hand_side) {
  right_hand_side_ = right_hand_side;
  solve_refined(true);
  right_hand_side = solution_.cwiseProduct(row_scale_);
}

}  // namespace arcslip::continuation
