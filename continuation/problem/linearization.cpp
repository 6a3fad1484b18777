#include "arcslip/continuation/problem/linearization.hpp"

#include <cmath>

#include "arcslip/continuation/problem/evaluation.hpp"

namespace arcslip::continuation {

Linearization::Linearization(const Problem& problem)
    : problem_(problem),
      sparse_(problem.sparse()),
      residual_(problem.size()),
      parameter_jacobian_(problem.size(), static_cast<Index>(problem.parameter_names().size())) {
  if (sparse_) {
    sparse_jacobian_.resize(problem.size(), problem.size());
  } else {
    jacobian_.resize(problem.size(), problem.size());
  }
}

bool Linearization::evaluate(const Vector& u, const Vector& p, const Regime& regime) {
  ++evaluations_;
  const Evaluation out{&residual_, sparse_ ? nullptr : &jacobian_, &parameter_jacobian_,
                       sparse_ ? &sparse_jacobian_ : nullptr};
  return continuation::evaluate(problem_, u, p, regime, out);
}

void Linearization::multiply(const Vector& x, Vector& out) const {
  if (sparse_) {
    out.noalias() = sparse_jacobian_ * x;
  } else {
    out.noalias() = jacobian_ * x;
  }
}

void Linearization::multiply_transposed(const Vector& x, Vector& out) const {
  if (sparse_) {
    out.noalias() = sparse_jacobian_.transpose() * x;
  } else {
    out.noalias() = jacobian_.transpose() * x;
  }
}

void Linearization::multiply_absolute(const Vector& x, Vector& out) const {
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

void Linearization::fill(BorderedSolver& solver, const Vector& column_scale) const {
  if (sparse_) {
    solver.set_jacobian(sparse_jacobian_, column_scale);
  } else {
    solver.set_jacobian(jacobian_, column_scale);
  }
}

}  // namespace arcslip::continuation
