#include "arcslip/continuation/cycles/doubling_problem.hpp"

#include <Eigen/LU>
#include <cmath>

#include "arcslip/continuation/cycles/floquet.hpp"
#include "arcslip/continuation/cycles/multiplier_form.hpp"

namespace arcslip::continuation {

DoublingProblem::DoublingProblem(const Problem& base, Index active)
    : SingularProblem(base, active, count_beside_duration(base)),
      orbits_(dynamic_cast<const PeriodicOrbit*>(&base)) {}

void DoublingProblem::fill(BorderedSolver& solver, double shift) const {
  if (orbits_ == nullptr) {
    Matrix beside = at_.jacobian();
    beside.diagonal() += Vector::Constant(count_, 2) + shift * scale_.cwiseInverse();
    solver.set_jacobian(beside, scale_);
    return;
  }
  SparseMatrix twisted = at_.sparse_jacobian().topLeftCorner(count_, count_);
  for (Index column = 0; column < orbits_->field().size(); ++column) {
    for (SparseMatrix::InnerIterator entry(twisted, column); entry; ++entry) {
      if (orbits_->joins_rounds(entry.row(), column)) entry.valueRef() *= -1;
    }
  }
  twisted.makeCompressed();
  solver.set_jacobian(twisted, scale_);
}

bool DoublingProblem::eigenvalues(const Vector& u, const Vector& p, const Regime& regime,
                                  ComplexVector& values) const {
  const BasePoint point = split(u, p, regime);
  ComplexVector all = log_multipliers_anew(base(), at_, point);
  if (all.size() == 0) return false;
  remove_multiplier(all, Complex(0, pi));
  values = rates_of(base(), all, point);
  return values.allFinite();
}

/// c over the size of its terms, prod (1 - mu), each factor over 1 + |mu|, and prod (1 + mu) of the others.
void DoublingProblem::test(const Vector& u, const Vector& p, const Regime& regime, Vector& values) const {
  const BasePoint point = split(u, p, regime);
  const auto form =
      multiplier_form(base(), PointType::period_doubling, {point.unknowns, point.parameters, regime, {}});
  values.setConstant(3, std::nan(""));
  if (form) values(0) = form->relative();
  const ComplexVector all = log_multipliers_anew(base(), at_, point);
  values(1) = fold_test(all);
  values(2) = second_doubling_test(all);
}

}  // namespace arcslip::continuation
