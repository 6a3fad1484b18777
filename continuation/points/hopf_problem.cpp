#include "arcslip/continuation/points/hopf_problem.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "arcslip/continuation/linear/borders.hpp"
#include "arcslip/continuation/points/hopf_form.hpp"

namespace arcslip::continuation {

HopfProblem::HopfProblem(const Problem& base, Index active)
    : ExtendedProblem(base, active, 2),
      solver_(make_bordered_solver(2 * base.size(), 2, false)),
      column_(spread(2 * base.size(), 1)),
      row_(spread(2 * base.size(), 2)),
      doubled_(Matrix::Zero(2 * base.size(), 2 * base.size())),
      second_(base),
      right_(2 * base.size() + 2),
      left_{right_, right_} {
  if (base.sparse()) throw std::invalid_argument("HopfProblem: only for dense problems");
}

bool HopfProblem::solve_borders(double kappa) const {
  const Index n = base().size();
  doubled_.topLeftCorner(n, n) = at_.jacobian();
  doubled_.bottomRightCorner(n, n) = at_.jacobian();
  doubled_.topRightCorner(n, n).diagonal().setConstant(kappa);
  doubled_.bottomLeftCorner(n, n).diagonal().setConstant(-1);
  solver_->set_jacobian(doubled_, Vector::Ones(2 * n));
  solver_->columns() << column_.head(n), -kappa * column_.tail(n), column_.tail(n), column_.head(n);
  solver_->rows() << row_.head(n).transpose(), -kappa * row_.tail(n).transpose(), row_.tail(n).transpose(),
      row_.head(n).transpose();
  solver_->corner().setZero();
  if (solver_->factor() == 0) return false;
  right_.setUnit(2 * n);
  solver_->solve(right_);
  for (Index j = 0; j < 2; ++j) {
    left_[j].setUnit(2 * n + j);
    solver_->solve_transposed(left_[j]);
  }
  return right_.allFinite() && left_[0].allFinite() && left_[1].allFinite();
}

bool HopfProblem::adapt(const BasePoint& point) {
  if (!ExtendedProblem::adapt(point)) return false;
  const Index n = base().size();
  const double size = at_.jacobian().cwiseAbs().rowwise().sum().maxCoeff() + 1;
  for (int i = 0; i < 3; ++i) {  // inverse iteration, with the conjugates of both null vectors
    if (!solve_borders(point.extras(0))) return false;
    column_ << left_[1].segment(n, n), -left_[1].head(n);
    column_ *= size / column_.norm();
    row_ << right_.head(n), -right_.segment(n, n);
    row_.normalize();
  }
  column_ *= steepness(point);
  return true;
}

void HopfProblem::each_border(const std::function<void(double*, Index)>& use) {
  ExtendedProblem::each_border(use);
  use(column_.data(), column_.size());
  use(row_.data(), row_.size());
  use(&second_.memory(), 1);
}

double HopfProblem::strain() const {
  const Index n = base().size();
  return std::max(right_.head(2 * n).norm(), left_[0].head(2 * n).norm() * column_.norm());
}

bool HopfProblem::conditions(const BasePoint& point, Vector& values, Matrix* gradients) const {
  if (!solve_borders(point.extras(0))) return false;
  const Index n = base().size();
  values = right_.tail(2);
  if (gradients == nullptr) return true;
  const Vector none = Vector::Zero(point.parameters.size());
  const Vector real = right_.head(n);
  const Vector imaginary = right_.segment(n, n);
  const Vector by_kappa = imaginary - column_.tail(n) * right_(2 * n + 1);
  gradients->setZero();
  Matrix weights(n, 2);
  Matrix columns;
  for (const bool first : {true, false}) {
    for (Index j = 0; j < 2; ++j) weights.col(j) = left_[j].segment(first ? 0 : n, n);
    if (!second_.contract(point.unknowns, point.parameters, point.regime, weights, first ? real : imaginary,
                          none, columns)) {
      return false;
    }
    gradients->leftCols(columns.rows()) -= columns.transpose();
  }
  for (Index j = 0; j < 2; ++j)
    (*gradients)(j, columns.rows()) =
        left_[j](2 * n) * row_.tail(n).dot(imaginary) - left_[j].head(n).dot(by_kappa);
  return true;
}

std::vector<Observable> HopfProblem::observables() const {
  std::vector<Observable> result = ExtendedProblem::observables();
  result.push_back({"omega"});
  return result;
}

void HopfProblem::observe(const Vector& u, const Vector& p, const Regime& regime, Vector& values) const {
  Vector of_base;
  ExtendedProblem::observe(u, p, regime, of_base);
  values.resize(of_base.size() + 1);
  values << of_base, std::sqrt(std::max(0.0, u(u.size() - 1)));
}

bool HopfProblem::eigenvalues(const Vector& u, const Vector& p, const Regime& regime,
                              ComplexVector& values) const {
  const BasePoint point = split(u, p, regime);
  if (!base().eigenvalues(point.unknowns, point.parameters, regime, values)) return false;
  const Complex critical = std::sqrt(Complex(-point.extras(0)));
  remove_nearest(values, critical);
  remove_nearest(values, -critical);
  return true;
}

void HopfProblem::test(const Vector& u, const Vector& p, const Regime& regime, Vector& values) const {
  const BasePoint point = split(u, p, regime);
  const double kappa = point.extras(0);
  values.resize(2);
  values << kappa, std::nan("");
  ComplexVector all;
  if (!base().eigenvalues(point.unknowns, point.parameters, regime, all)) return;
  constexpr double surely = 1e-6;  // so near to where the pair meets at 0 its vectors are rounding
  if (!(kappa > surely * all.cwiseAbs2().maxCoeff())) return;
  const auto form = hopf_form(base(), {point.unknowns, point.parameters, regime}, std::sqrt(kappa));
  if (form && form->terms > 0) values(1) = form->lyapunov / form->terms;  // jumps where terms have poles
}

}  // namespace arcslip::continuation
