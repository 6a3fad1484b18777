#include "arcslip/continuation/linear/sparse_bordered_solver.hpp"

#include <klu.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <new>
#include <stdexcept>
#include <vector>

namespace arcslip::continuation {
namespace {

constexpr double border_weight = 1e-6;  // of a border row's largest entry where that of others is 1 to 2
// Of a diagonal entry over the largest of its column, where it is taken as a pivot: a hundredth of that, as
// is the rule, lets entries grow so much that solutions along orbits with multipliers of 1e-30 lose all
// digits.
constexpr double least_pivot = 0.1;
constexpr double worst_growth = 1e-3;  // of the pivots' growth when they were chosen
constexpr double exact_enough = 1e-8;  // of a correction: its square is below rounding
constexpr int most_refinements = 4;
constexpr double most_fill = 2;  // over the least: pivots that fill more were a makeshift, which is not kept

/// The power of two that scales x > 0 to between 1 and 2, by its bits; calls would take a twentieth of all.
double scale_to_one(double x) {
  constexpr int fraction = 52;
  constexpr std::uint64_t most = 2046;  // exponents, from 1
  const std::uint64_t exponent = std::bit_cast<std::uint64_t>(x) >> fraction;
  if (exponent < 1 || exponent >= most) return std::ldexp(1.0, -std::ilogb(x));
  return std::bit_cast<double>((most - exponent) << fraction);
}

}  // namespace

/// Owns what KLU allocates.
struct SparseBorderedSolver::Factors {
  explicit Factors(Index rows) : seen(static_cast<std::size_t>(rows)) {
    klu_defaults(&common);
    common.btf = 0;  // the borders couple everything to one block
    common.scale = -1;
    common.tol = least_pivot;
  }
  ~Factors() { clear(); }
  Factors(const Factors&) = delete;
  Factors& operator=(const Factors&) = delete;

  void clear() {
    klu_free_numeric(&numeric, &common);
    klu_free_symbolic(&symbolic, &common);
  }

  void check_memory() const {
    if (common.status == KLU_OUT_OF_MEMORY) throw std::bad_alloc();
    if (common.status < 0)
      throw std::length_error("sparse factorisation: more entries than indices can count");
  }

  void analyze(SparseMatrix& matrix, std::vector<int>& order) {
    clear();
    symbolic = klu_analyze_given(static_cast<int>(matrix.rows()), matrix.outerIndexPtr(),
                                 matrix.innerIndexPtr(), order.data(), order.data(), &common);
    if (symbolic == nullptr) check_memory();
    least_fill = 0;
  }

  bool factor_with_new_pivots(SparseMatrix& matrix) {
    klu_free_numeric(&numeric, &common);
    numeric =
        klu_factor(matrix.outerIndexPtr(), matrix.innerIndexPtr(), matrix.valuePtr(), symbolic, &common);
    check_memory();
    if (numeric == nullptr || common.status != KLU_OK) return false;
    least_fill = least_fill > 0 ? std::min(least_fill, fill()) : fill();
    chosen_growth = growth(matrix);
    permutations_sign = permutation_sign(numeric->Pnum, seen) * permutation_sign(symbolic->Q, seen);
    return true;
  }

  bool factor_with_old_pivots(SparseMatrix& matrix) {
    if (numeric == nullptr || fill() > most_fill * least_fill) return false;
    const int done = klu_refactor(matrix.outerIndexPtr(), matrix.innerIndexPtr(), matrix.valuePtr(), symbolic,
                                  numeric, &common);
    return done != 0 && common.status == KLU_OK && growth(matrix) >= worst_growth * chosen_growth;
  }

  double fill() const { return static_cast<double>(numeric->lnz) + static_cast<double>(numeric->unz); }

  /// Reciprocal growth of the entries in the elimination: small where the pivots are bad.
  double growth(SparseMatrix& matrix) {
    klu_rgrowth(matrix.outerIndexPtr(), matrix.innerIndexPtr(), matrix.valuePtr(), symbolic, numeric,
                &common);
    return common.rgrowth;
  }

  double sign() const {
    const auto* pivots = static_cast<const double*>(numeric->Udiag);
    double sign = permutations_sign;
    for (int i = 0; i < numeric->n; ++i) {
      if (pivots[i] == 0 || !std::isfinite(pivots[i])) return 0;
      if (pivots[i] < 0) sign = -sign;
    }
    return sign;
  }

  klu_common common{};
  klu_symbolic* symbolic = nullptr;
  klu_numeric* numeric = nullptr;
  double chosen_growth = 1;
  double least_fill = 0;  // since the matrix was analysed
  double permutations_sign = 1;
  std::vector<char> seen;
};

SparseBorderedSolver::SparseBorderedSolver(Index size, Index borders)
    : BorderedSolver(size, borders),
      row_scale_(size + borders),
      right_hand_side_(size + borders),
      solution_(size + borders),
      residual_(size + borders),
      factors_(std::make_unique<Factors>(size + borders)) {}

SparseBorderedSolver::~SparseBorderedSolver() = default;

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

  std::vector<int> order(static_cast<std::size_t>(rows));
  const int status = amd_order(static_cast<int>(n), jacobian.outerIndexPtr(), jacobian.innerIndexPtr(),
                               order.data(), nullptr, nullptr);
  if (status == AMD_OUT_OF_MEMORY) throw std::bad_alloc();
  if (status < 0) throw std::invalid_argument("set_jacobian: the sparse Jacobian is not a valid matrix");
  for (Index i = n; i < rows; ++i) order[static_cast<std::size_t>(i)] = static_cast<int>(i);
  factors_->analyze(matrix_, order);
}

void SparseBorderedSolver::set_jacobian(const SparseMatrix& jacobian, const Vector& column_scale) {
  if (!jacobian.isCompressed() || jacobian.rows() != size() || jacobian.cols() != size()) {
    throw std::invalid_argument("set_jacobian: a compressed matrix of the solver's size is needed");
  }
  if (!same_pattern(jacobian)) set_pattern(jacobian);
  for (Index j = 0; j < size(); ++j) {
    const int begin = jacobian.outerIndexPtr()[j];
    const int count = jacobian.outerIndexPtr()[j + 1] - begin;
    double* ours = matrix_.valuePtr() + matrix_.outerIndexPtr()[j];
    for (int k = 0; k < count; ++k) ours[k] = jacobian.valuePtr()[begin + k] * column_scale(j);
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

/// Powers of two, exact. False if a row is zero or not finite.
bool SparseBorderedSolver::scale_rows() {
  const double* values = matrix_.valuePtr();
  const int* rows = matrix_.innerIndexPtr();
  const Index count = matrix_.nonZeros();
  row_scale_.setZero();
  double finite = 0;
  for (Index k = 0; k < count; ++k) {
    row_scale_(rows[k]) = std::max(row_scale_(rows[k]), std::abs(values[k]));
    finite += 0 * values[k];  // stays 0, or is nan from then on
  }
  if (!(finite == 0) || !(row_scale_.minCoeff() > 0)) return false;
  for (double& scale : row_scale_) scale = scale_to_one(scale);
  row_scale_.tail(borders()) *= border_weight;
  for (Index k = 0; k < count; ++k) scaled_.valuePtr()[k] = values[k] * row_scale_(rows[k]);
  return true;
}

double SparseBorderedSolver::factor() {
  if (factors_->symbolic == nullptr) return 0;
  set_borders();
  if (!scale_rows()) return 0;
  if (factors_->factor_with_old_pivots(scaled_)) {
    const double sign = factors_->sign();
    if (sign != 0) return sign;
  }
  return factors_->factor_with_new_pivots(scaled_) ? factors_->sign() : 0;
}

void SparseBorderedSolver::multiply_determinant(LogProduct& product) const {
  const auto* pivots = static_cast<const double*>(factors_->numeric->Udiag);
  for (Index i = 0; i < matrix_.rows(); ++i) product *= pivots[i] / row_scale_(i);
}

/// Solves for right_hand_side_ with the scaled matrix, into solution_. The corrections of a refinement shrink
/// by one factor, so that the first tells whether it is enough.
void SparseBorderedSolver::solve_refined(bool transposed) {
  const int rows = static_cast<int>(matrix_.rows());
  const auto solve_once = transposed ? klu_tsolve : klu_solve;
  Factors& f = *factors_;
  // The unknowns of the transposed system are those of `solution_` times the rows' scale.
  const auto size_of = [&](const Vector& x) {
    return transposed ? x.cwiseProduct(row_scale_).lpNorm<Eigen::Infinity>() : x.lpNorm<Eigen::Infinity>();
  };
  solution_ = right_hand_side_;
  solve_once(f.symbolic, f.numeric, rows, 1, solution_.data(), &f.common);
  double last = size_of(solution_);
  for (int i = 0; i < most_refinements; ++i) {
    residual_ = right_hand_side_;
    if (transposed) {
      residual_.noalias() -= scaled_.transpose() * solution_;
    } else {
      residual_.noalias() -= scaled_ * solution_;
    }
    solve_once(f.symbolic, f.numeric, rows, 1, residual_.data(), &f.common);
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
