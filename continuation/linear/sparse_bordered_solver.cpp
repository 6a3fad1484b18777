#include "arcslip/continuation/linear/sparse_bordered_solver.hpp"

#include <amd.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <new>
#include <stdexcept>
#include <utility>
#include <vector>

namespace arcslip::continuation {
namespace {

constexpr double dense_gain = 6;       // in multiplications a second, of fronts over single entries
constexpr double little_growth = 1e3;  // of entries in fronts: these digits are not missed
constexpr double most_lost = 1e12;     // of these, to which refinement gives back the digits
constexpr double exact_enough = 1e-8;  // of a correction: its square is below rounding
constexpr int most_refinements = 4;

}  // namespace

SparseBorderedSolver::SparseBorderedSolver(Index size, Index borders)
    : BorderedSolver(size, borders),
      right_hand_side_(size + borders),
      solution_(size + borders),
      residual_(size + borders) {}

thread_local SparseBorderedSolver::Plan SparseBorderedSolver::spare;

SparseBorderedSolver::~SparseBorderedSolver() {
  constexpr Index most = 1000000;  // entries, which take more time than a plan for them
  if (plan_.matrix.nonZeros() < most) spare = std::move(plan_);
}

bool SparseBorderedSolver::same_pattern(const SparseMatrix& jacobian) const {
  const int* const begins = jacobian.outerIndexPtr();
  const int* const rows = jacobian.innerIndexPtr();
  return plan_.borders == borders() &&
         std::equal(begins, begins + size() + 1, plan_.begins.begin(), plan_.begins.end()) &&
         std::equal(rows, rows + begins[size()], plan_.rows.begin(), plan_.rows.end());
}

void SparseBorderedSolver::set_pattern(const SparseMatrix& jacobian) {
  std::swap(plan_, spare);
  klu_.reset();
  if (same_pattern(jacobian)) return;
  const Index n = size();
  const Index rows = n + borders();
  plan_.borders = -1;
  plan_.matrix.resize(rows, rows);
  plan_.matrix.reserve(jacobian.nonZeros() + (rows + n) * borders());
  for (Index j = 0; j < rows; ++j) {
    plan_.matrix.startVec(j);
    if (j < n) {
      for (SparseMatrix::InnerIterator entry(jacobian, j); entry; ++entry) {
        plan_.matrix.insertBack(entry.row(), j) = 0;
      }
    }
    for (Index i = j < n ? n : 0; i < rows; ++i) plan_.matrix.insertBack(i, j) = 0;
  }
  plan_.matrix.finalize();

  plan_.order.resize(static_cast<std::size_t>(rows));
  double info[AMD_INFO];
  const int status = amd_order(static_cast<int>(n), jacobian.outerIndexPtr(), jacobian.innerIndexPtr(),
                               plan_.order.data(), nullptr, info);
  if (status == AMD_OUT_OF_MEMORY) throw std::bad_alloc();
  if (status < 0) throw std::invalid_argument("set_jacobian: the sparse Jacobian is not a valid matrix");
  for (Index i = n; i < rows; ++i) plan_.order[static_cast<std::size_t>(i)] = static_cast<int>(i);
  find_last_rows(jacobian);
  plan_.dense = make_alike_factors(plan_.matrix, borders());
  if (plan_.dense == nullptr)
    plan_.dense = make_frontal_factors(plan_.matrix, borders(), dense_gain * info[AMD_NMULTSUBS_LU]);
  plan_.begins.assign(jacobian.outerIndexPtr(), jacobian.outerIndexPtr() + n + 1);
  plan_.rows.assign(jacobian.innerIndexPtr(), jacobian.innerIndexPtr() + jacobian.nonZeros());
  plan_.borders = borders();
}

/// Those of the borders, and those which AMD sets aside for the end as it takes them for full.
void SparseBorderedSolver::find_last_rows(const SparseMatrix& jacobian) {
  const double most = std::max(16.0, AMD_DEFAULT_DENSE * std::sqrt(static_cast<double>(size())));
  std::vector<int> count(static_cast<std::size_t>(size()), 0);
  for (Index k = 0; k < jacobian.nonZeros(); ++k)
    ++count[static_cast<std::size_t>(jacobian.innerIndexPtr()[k])];
  plan_.last_rows.clear();
  for (Index i = 0; i < size() + borders(); ++i) {
    if (i >= size() || count[static_cast<std::size_t>(i)] > most) plan_.last_rows.push_back(i);
  }
}

void SparseBorderedSolver::set_jacobian(const SparseMatrix& jacobian, const Vector& column_scale) {
  if (!jacobian.isCompressed() || jacobian.rows() != size() || jacobian.cols() != size()) {
    throw std::invalid_argument("set_jacobian: a compressed matrix of the solver's size is needed");
  }
  if (!same_pattern(jacobian)) set_pattern(jacobian);
  for (Index j = 0; j < size(); ++j) {
    const int begin = jacobian.outerIndexPtr()[j];
    const int count = jacobian.outerIndexPtr()[j + 1] - begin;
    const double* __restrict const values = jacobian.valuePtr() + begin;
    double* __restrict const ours = plan_.matrix.valuePtr() + plan_.matrix.outerIndexPtr()[j];
    const double scale = column_scale(j);
    for (int k = 0; k < count; ++k) ours[k] = values[k] * scale;
  }
}

void SparseBorderedSolver::set_borders() {
  for (Index j = 0; j < plan_.matrix.cols(); ++j) {
    double* end = plan_.matrix.valuePtr() + plan_.matrix.outerIndexPtr()[j + 1];
    if (j < size()) {
      for (Index k = 0; k < borders(); ++k) end[k - borders()] = rows()(k, j);
    } else {
      const Index k = j - size();
      std::copy_n(corner().data() + k * borders(), borders(), end - borders());
      std::copy_n(columns().data() + k * size(), size(), end - borders() - size());
    }
  }
}

/// Where entries grow in fronts beyond what refinement makes good, by single entries, if they grow less
/// there.
double SparseBorderedSolver::factor() {
  if (plan_.matrix.rows() == 0) return 0;
  set_borders();
  if (plan_.dense == nullptr) return factor_by_entries();
  factors_ = plan_.dense.get();
  const double sign = plan_.dense->factor(plan_.matrix);
  if (sign != 0 && plan_.dense->growth() < most_lost) return sign;
  const double by_entries = factor_by_entries();
  if (sign == 0 || (by_entries != 0 && klu_->growth() < plan_.dense->growth())) return by_entries;
  factors_ = plan_.dense.get();
  return sign;
}

double SparseBorderedSolver::factor_by_entries() {
  if (klu_ == nullptr) klu_ = make_klu_factors(plan_.matrix, plan_.order, plan_.last_rows);
  factors_ = klu_.get();
  return klu_->factor(plan_.matrix);
}

void SparseBorderedSolver::multiply_determinant(LogProduct& product) const {
  factors_->multiply_determinant(product);
}

/// Solves for right_hand_side_, into solution_. Where dense factors are of no use, those of single entries
/// take their place.
void SparseBorderedSolver::solve_refined(bool transposed) {
  if (!refine(transposed) && factors_ == plan_.dense.get() && factor_by_entries() != 0) refine(transposed);
}

/// The corrections of a refinement shrink by one factor, so that the first tells whether it is enough; where
/// the factors lack many digits, it may be as large as what it corrects. False if corrections do not become
/// small.
bool SparseBorderedSolver::refine(bool transposed) {
  const auto solve_once = [&](Vector& x) { transposed ? factors_->solve_transposed(x) : factors_->solve(x); };
  solution_ = right_hand_side_;
  solve_once(solution_);
  if (factors_ == plan_.dense.get() && factors_->growth() < little_growth) return true;
  double last = std::numeric_limits<double>::infinity();
  for (int i = 0; i < most_refinements; ++i) {
    residual_ = right_hand_side_;
    if (transposed) {
      residual_.noalias() -= plan_.matrix.transpose() * solution_;
    } else {
      residual_.noalias() -= plan_.matrix * solution_;
    }
    solve_once(residual_);
    const double length = residual_.lpNorm<Eigen::Infinity>();
    if (!(length < 0.5 * last)) break;
    solution_ += residual_;
    if (length <= exact_enough * solution_.lpNorm<Eigen::Infinity>()) return true;
    last = length;
  }
  return last < 0.5 * solution_.lpNorm<Eigen::Infinity>();
}

void SparseBorderedSolver::solve(Vector& right_hand_side) {
  right_hand_side_ = right_hand_side;
  solve_refined(false);
  right_hand_side = solution_;
}

void SparseBorderedSolver::solve_transposed(Vector& right_hand_side) {
  right_hand_side_ = right_hand_side;
  solve_refined(true);
  right_hand_side = solution_;
}

}  // namespace arcslip::continuation
