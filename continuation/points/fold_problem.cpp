#include "arcslip/continuation/points/fold_problem.hpp"

#include <algorithm>
#include <cmath>

#include "arcslip/continuation/linear/borders.hpp"

namespace arcslip::continuation {

FoldProblem::FoldProblem(const Problem& base, Index active)
    : ExtendedProblem(base, active, 1),
      solver_(make_bordered_solver(base.size(), 1, base.sparse())),
      column_(spread(base.size(), 1)),
      row_(spread(base.size(), 2)),
      second_(base),
      right_(base.size() + 1),
      left_(base.size() + 1) {}

bool FoldProblem::solve_borders() const {
  const Index n = base().size();
  at_.fill(*solver_, scale_);
  solver_->columns().col(0) = column_;
  solver_->rows().row(0) = row_.transpose();
  solver_->corner()(0, 0) = 0;
  if (solver_->factor() == 0) return false;
  right_.setUnit(n);
  solver_->solve(right_);
  left_.setUnit(n);
  solver_->solve_transposed(left_);
  return right_.allFinite() && left_.allFinite();
}

bool FoldProblem::adapt(const BasePoint& point) {
  if (!ExtendedProblem::adapt(point)) return false;
  const Index n = base().size();
  const double size = column_size(at_, scale_);
  for (int i = 0; i < 3; ++i) {  // inverse iteration
    if (!solve_borders()) return false;
    column_ = left_.head(n) * (size / left_.head(n).norm());
    row_ = right_.head(n).normalized();
  }
  column_ *= steepness(point);
  return true;
}

void FoldProblem::each_border(const std::function<void(double*, Index)>& use) {
  ExtendedProblem::each_border(use);
  use(column_.data(), column_.size());
  use(row_.data(), row_.size());
  use(&second_.memory(), 1);
}

double FoldProblem::strain() const {
  const Index n = base().size();
  return std::max(right_.head(n).norm(), left_.head(n).norm() * column_.norm());
}

bool FoldProblem::conditions(const BasePoint& point, Vector& values, Matrix* gradients) const {
  if (!solve_borders()) return false;
  const Index n = base().size();
  values(0) = right_(n);
  if (gradients == nullptr) return true;
  Vector row;
  const Vector none = Vector::Zero(point.parameters.size());
  if (!second_.contract(point.unknowns, point.parameters, point.regime, left_.head(n), right_null(), none,
                        row))
    return false;
  gradients->row(0) = -row.transpose();
  return true;
}

Vector FoldProblem::right_null() const { return scale_.cwiseProduct(right_.head(base().size())); }

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
  if (values.size() > 1) values(1) = w.dot(v) / (w.norm() * v.norm());
}

bool FoldProblem::eigenvalues(const Vector& u, const Vector& p, const Regime& regime,
                              ComplexVector& values) const {
  const BasePoint point = split(u, p, regime);
  if (!base().eigenvalues(point.unknowns, point.parameters, regime, values)) return false;
  remove_zero(values);
  return true;
}

}  // namespace arcslip::continuation
