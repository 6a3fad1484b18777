#include "arcslip/continuation/problem/linearization.hpp"

#include <cmath>

#include "arcslip/continuation/linear/condensed_bordered_solver.hpp"
#include "arcslip/continuation/problem/evaluation.hpp"

namespace arcslip::continuation {

Linearization::Linearization(const Problem& problem, bool as_matrix)
    : problem_(problem),
      sparse_(problem.sparse()),
      residual_(problem.size()),
      parameter_jacobian_(problem.size(), static_cast<Index>(problem.parameter_names().size())) {
  if (!as_matrix) condensed_ = problem.condensed_jacobian();
  if (condensed_ != nullptr) return;
  if (sparse_) {
    sparse_jacobian_.resize(problem.size(), problem.size());
  } else {
    jacobian_.resize(problem.size(), problem.size());
  }
}

bool Linearization::evaluate(const Vector& u, const Vector& p, const Regime& regime, bool by_parameters) {
  ++evaluations_;
  Evaluation out{.residual = &residual_};
  if (by_parameters) out.parameter_jacobian = &parameter_jacobian_;
  if (condensed_ != nullptr) {
    out.condensed_jacobian = condensed_.get();
  } else if (sparse_) {
    out.sparse_jacobian = &sparse_jacobian_;
  } else {
    out.jacobian = &jacobian_;
  }
  return continuation::evaluate(problem_, u, p, regime, out);
}

void Linearization::multiply(const Vector& x, Vector& out) const {
  if (condensed_ != nullptr) {
    condensed_->multiply(x, out);
  } else if (sparse_) {
    out.noalias() = sparse_jacobian_ * x;
  } else {
    out.noalias() = jacobian_ * x;
  }
}

void Linearization::multiply_transposed(const Vector& x, Vector& out) const {
  if (condensed_ != nullptr) {
    condensed_->multiply_transposed(x, out);
  } else if (sparse_) {
    out.noalias() = sparse_jacobian_.transpose() * x;
  } else {
    out.noalias() = jacobian_.transpose() * x;
  }
}

void Linearization::multiply_absolute(const Vector& x, Vector& out) const {
  if (condensed_ != nullptr) return condensed_->multiply_absolute(x, out);
  out.setZero();
  for (Index j = 0; j < x.size(); ++j) {
    const double factor = std::abs(x(j));
    if (!sparse_) {
      out += factor * jacobian_.col(j).cwiseAbs();
      continue;
    }
    for (SparseMatrix::InnerIterator entry(sparse_jacobian_, j); entry; ++entry) {
      out(entry.row()) += factor * std::abs(entry.value());
    }
  }
}

std::unique_ptr<BorderedSolver> Linearization::make_solver(Index borders) const {
  if (condensed_ != nullptr) return std::make_unique<CondensedBorderedSolver>(residual_.size(), borders);
  return make_bordered_solver(residual_.size(), borders, sparse_);
}

void Linearization::fill(BorderedSolver& solver, const Vector& column_scale) const {
  if (condensed_ != nullptr) {
    solver.set_jacobian(*condensed_, column_scale);
  } else if (sparse_) {
    solver.set_jacobian(sparse_jacobian_, column_scale);
  } else {
    solver.set_jacobian(jacobian_, column_scale);
  }
}

}  // namespace arcslip::continuation
