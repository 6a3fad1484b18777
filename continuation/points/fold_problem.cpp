#include "arcslip/continuation/points/fold_problem.hpp"

#include <algorithm>
#include <cmath>

#include "arcslip/continuation/cycles/floquet.hpp"
#include "arcslip/continuation/cycles/periodic_orbit.hpp"
#include "arcslip/continuation/points/normal_form.hpp"

namespace arcslip::continuation {

FoldProblem::FoldProblem(const Problem& base, Index active) : SingularProblem(base, active, base.size()) {}

void FoldProblem::fill(BorderedSolver& solver, double shift) const {
  at_.fill(solver, scale_);
  if (shift == 0 || at_.sparse()) return;
  const Matrix shifts = shift * scale_.cwiseInverse().asDiagonal();
  solver.set_jacobian(Matrix(at_.jacobian() + shifts), scale_);
}

double FoldProblem::quadratic(const BasePoint& point) const {
  // 0 = w^T F_p (p_a - p_a*) + 1/2 w^T F_uu v v x^2 + ...
  const Index n = base().size();
  const Vector v = right_null();
  const Vector w = left_.head(n);
  const double length = right_.head(n).norm();
  const double by_parameter = w.dot(at_.parameter_jacobian().col(active()));
  Vector row;
  const Vector none = Vector::Zero(point.parameters.size());
  if (!second_.contract(point.unknowns, point.parameters, point.regime, w, v, none, row)) return std::nan("");
  return -0.5 * row.head(n).dot(v) / (length * length * by_parameter);
}

std::vector<PointType> FoldProblem::test_types() const {
  if (base().has_multipliers()) return {PointType::cusp, PointType::fold_flip, PointType::resonance_1_1};
  if (!base().is_equilibrium()) return {PointType::cusp};
  return {PointType::cusp, PointType::bogdanov_takens};
}

void FoldProblem::test(const Vector& u, const Vector& p, const Regime& regime, Vector& values) const {
  const BasePoint point = split(u, p, regime);
  const Index n = base().size();
  values.setConstant(static_cast<Index>(test_types().size()), std::nan(""));
  if (!at_.evaluate(point.unknowns, point.parameters, regime) || !solve_borders()) return;
  const Vector v = right_null();
  const Vector w = left_.head(n);
  Vector row;
  const Vector none = Vector::Zero(point.parameters.size());
  // |b| is the size of dF/du D, so that w^T F_uu v v is a pure number
  if (second_.contract(point.unknowns, point.parameters, regime, w, v, none, row))
    values(0) = row.head(n).dot(v);
  if (base().has_multipliers()) {
    values(2) = second_fold_test(log_multipliers(base(), at_, point));
    const std::vector<PointType> types = base().test_types();
    const auto doubling = std::find(types.begin(), types.end(), PointType::period_doubling);
    Vector of_base(std::ssize(types));
    if (doubling == types.end()) return;
    base().test(point.unknowns, point.parameters, regime, of_base);
    values(1) = of_base(doubling - types.begin());
  } else if (values.size() > 1) {
    values(1) = w.dot(v) / (w.norm() * v.norm());
  }
}

PointType FoldProblem::turn(const Vector& u, const Vector& p, const Regime& regime) const {
  const BasePoint at = split(u, p, regime);
  return turn_of_folds(base(), active(), {at.unknowns, at.parameters, regime, {}});
}

}  // namespace arcslip::continuation
