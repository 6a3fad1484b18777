#include "arcslip/continuation/linear/condensed_bordered_solver.hpp"

#include <cmath>
#include <limits>
#include <stdexcept>

#include "arcslip/continuation/linear/dense_bordered_solver.hpp"
#include "arcslip/continuation/linear/krylov_bordered_solver.hpp"

namespace arcslip::continuation {

CondensedBorderedSolver::CondensedBorderedSolver(Index size, Index borders, Index factored_up_to)
    : BorderedSolver(size, borders),
      factored_up_to_(factored_up_to),
      scale_(Vector::Ones(size)),
      beta_(size, borders + 1),
      gamma_(borders + 1, size),
      coupled_(size) {}

void CondensedBorderedSolver::set_jacobian(const CondensedJacobian& jacobian, const Vector& column_scale) {
  if (jacobian.weight().size() != size())
    throw std::logic_error("set_jacobian: a condensed Jacobian of another size");
  jacobian_ = &jacobian;
  unit_ = size() > 0 ? column_scale.head(size()).mean() : 1;
  scale_ = column_scale.head(size()) / unit_;
  weight_ = jacobian.weight() * unit_;
}

Vector CondensedBorderedSolver::chosen(const Vector& all) const { return all(jacobian_->active()); }

Vector CondensedBorderedSolver::spread(const Vector& active) const {
  Vector all = Vector::Zero(size());
  all(jacobian_->active()) = active;
  return all;
}

void CondensedBorderedSolver::set_borders() {
  const Index b = borders();
  const auto per_weight = weight_.cwiseInverse().asDiagonal();
  beta_.leftCols(b) = per_weight * columns();
  beta_.col(b) = -(per_weight * jacobian_->column());
  gamma_.topRows(b) = rows() * scale_.cwiseInverse().asDiagonal();
  gamma_.row(b) = -unit_ * jacobian_->row().transpose();
  inner_->columns() = beta_(jacobian_->active(), Eigen::all);
  for (Index k = 0; k <= b; ++k) {
    jacobian_->couple_transposed(gamma_.row(k).transpose(), coupled_);
    inner_->rows().row(k) = -chosen(coupled_).transpose();
  }
  inner_->corner().setZero();
  inner_->corner().topLeftCorner(b, b) = corner();
  inner_->corner()(b, b) = 1;
  inner_->corner().noalias() -= gamma_ * beta_;
}

/// 1 + K_aa as a matrix.
double CondensedBorderedSolver::factor_matrix() {
  const Index active = std::ssize(jacobian_->active());
  if (matrix_ == nullptr || matrix_->size() != active)
    matrix_ = std::make_unique<DenseBorderedSolver>(active, borders() + 1);
  k_.resize(active, active);
  jacobian_->fill(k_);
  k_.diagonal().array() += 1;
  matrix_->set_jacobian(k_, Vector::Ones(active));
  inner_ = matrix_.get();
  set_borders();
  return inner_->factor();
}

/// By iterations; nan where they do not converge.
double CondensedBorderedSolver::iterate() {
  const Index active = std::ssize(jacobian_->active());
  if (iterated_ == nullptr || iterated_->size() != active)
    iterated_ = std::make_unique<KrylovBorderedSolver>(active, borders() + 1);
  iterated_->set_jacobian(*jacobian_, scale_);
  inner_ = iterated_.get();
  set_borders();
  return inner_->factor();
}

void CondensedBorderedSolver::solve_inner(Vector& reduced, bool transposed) {
  const Vector right = reduced;
  const auto solve_by = [&] { transposed ? inner_->solve_transposed(reduced) : inner_->solve(reduced); };
  solve_by();
  if (inner_ == matrix_.get() || reduced.allFinite() || !right.allFinite()) return;
  factor_matrix();
  reduced = right;
  solve_by();
}

double CondensedBorderedSolver::factor() {
  double sign = std::numeric_limits<double>::quiet_NaN();
  if (std::ssize(jacobian_->active()) > factored_up_to_) sign = iterate();
  if (std::isnan(sign)) sign = factor_matrix();
  for (Index i = 0; i < size(); ++i) {
    if (weight_(i) * scale_(i) < 0) sign = -sign;
  }
  return sign;
}

void CondensedBorderedSolver::multiply_determinant(LogProduct& product) const {
  inner_->multiply_determinant(product);
  for (Index i = 0; i < size(); ++i) product *= weight_(i) * scale_(i);
}

void CondensedBorderedSolver::solve(Vector& right_hand_side) {
  const Index n = size();
  const Index b = borders();
  const Index active = inner_->size();
  const Vector q = right_hand_side.head(n).cwiseQuotient(weight_);
  Vector reduced(active + b + 1);
  reduced.head(active) = chosen(q);
  reduced.tail(b + 1) << right_hand_side.tail(b), 0;
  reduced.tail(b + 1).noalias() -= gamma_ * q;
  solve_inner(reduced, false);
  jacobian_->couple(spread(reduced.head(active)), coupled_);
  coupled_ = q - coupled_;
  coupled_.noalias() -= beta_ * reduced.tail(b + 1);
  right_hand_side.head(n) = coupled_.cwiseQuotient(scale_);
  right_hand_side.tail(b) = reduced.segment(active, b);
}

/// By the same matrix transposed: with a = f' - gamma^T b + w, w active alone, where f' = f/scale, of
/// diag(w)^{-1} times what is wanted.
void CondensedBorderedSolver::solve_transposed(Vector& right_hand_side) {
  const Index n = size();
  const Index b = borders();
  const Index active = inner_->size();
  const Vector f = right_hand_side.head(n).cwiseQuotient(scale_);
  jacobian_->couple_transposed(f, coupled_);
  Vector reduced(active + b + 1);
  reduced.head(active) = -chosen(coupled_);
  reduced.tail(b + 1) << right_hand_side.tail(b), 0;
  reduced.tail(b + 1).noalias() -= beta_.transpose() * f;
  solve_inner(reduced, true);
  coupled_ = f + spread(reduced.head(active));
  coupled_.noalias() -= gamma_.transpose() * reduced.tail(b + 1);
  right_hand_side.head(n) = coupled_.cwiseQuotient(weight_);
  right_hand_side.tail(b) = reduced.segment(active, b);
}

}  // namespace arcslip::continuation
