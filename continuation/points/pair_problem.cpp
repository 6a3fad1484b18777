#include "arcslip/continuation/points/pair_problem.hpp"

#include <algorithm>

#include "arcslip/continuation/linear/borders.hpp"

namespace arcslip::continuation {

PairProblem::PairProblem(const Problem& base, Index active)
    : ExtendedProblem(base, active, 2),
      count_(base.size()),
      solver_(make_bordered_solver(2 * count_, 2, base.sparse())),
      column_(spread(2 * count_, 1)),
      row_(spread(2 * count_, 2)),
      second_(base),
      right_(2 * count_ + 2),
      left_{right_, right_} {}

bool PairProblem::solve_borders(double kappa) const {
  const double a = sum(kappa).value;
  const double b = product(kappa).value;
  Vector scales(2 * count_);
  scales << scale_, scale_;
  fill(*solver_, a, b, scales);
  const auto first = column_.head(count_);
  const auto second = column_.tail(count_);
  solver_->columns() << first, -b * second, second, first + a * second;
  const auto of_first = row_.head(count_).transpose();
  const auto of_second = row_.tail(count_).transpose();
  solver_->rows() << of_first, -b * of_second, of_second, of_first + a * of_second;
  solver_->corner().setZero();
  if (solver_->factor() == 0) return false;
  right_.setUnit(2 * count_);
  solver_->solve(right_);
  for (Index j = 0; j < 2; ++j) {
    left_[j].setUnit(2 * count_ + j);
    solver_->solve_transposed(left_[j]);
  }
  return right_.allFinite() && left_[0].allFinite() && left_[1].allFinite();
}

bool PairProblem::adapt(const BasePoint& point) {
  if (!ExtendedProblem::adapt(point)) return false;
  const double size = column_size(at_, scale_);
  const double a = sum(point.extras(0)).value;
  for (int i = 0; i < 3; ++i) {  // inverse iteration, with the conjugates of both null vectors
    if (!solve_borders(point.extras(0))) return false;
    column_ << left_[1].segment(count_, count_), -left_[1].head(count_);
    column_ *= size / column_.norm();
    row_ << right_.head(count_) + a * right_.segment(count_, count_), -right_.segment(count_, count_);
    row_.normalize();
  }
  column_ *= steepness(point);
  return true;
}

void PairProblem::each_border(const std::function<void(double*, Index)>& use) {
  ExtendedProblem::each_border(use);
  use(column_.data(), column_.size());
  use(row_.data(), row_.size());
  use(&second_.memory(), 1);
}

double PairProblem::strain() const {
  return std::max(right_.head(2 * count_).norm(), left_[0].head(2 * count_).norm() * column_.norm());
}

bool PairProblem::conditions(const BasePoint& point, Vector& values, Matrix* gradients) const {
  const double kappa = point.extras(0);
  if (!solve_borders(kappa)) return false;
  values = right_.tail(2);
  if (gradients == nullptr) return true;
  const Vector none = Vector::Zero(point.parameters.size());
  gradients->setZero();
  Matrix weights(count_, 2);
  Matrix columns;
  for (const Index part : {0, 1}) {
    for (Index j = 0; j < 2; ++j) weights.col(j) = left_[j].segment(part * count_, count_);
    const Vector v = right_.segment(part * count_, count_).cwiseProduct(scale_);
    if (!second_.contract(point.unknowns, point.parameters, point.regime, weights, v, none, columns))
      return false;
    gradients->leftCols(columns.rows()) -= columns.transpose();
  }
  // what kappa moves: z^2 v_1, of the matrix and of both borders
  const auto second = right_.segment(count_, count_);
  const Vector moved = turned(second.cwiseProduct(scale_)) + column_.tail(count_) * right_(2 * count_ + 1);
  const double of_row = row_.tail(count_).dot(second);
  const double a = sum(kappa).slope;
  const double b = product(kappa).slope;
  Vector by_kappa(2 * count_ + 2);
  by_kappa << -b * moved, a * moved, -b * of_row, a * of_row;
  for (Index j = 0; j < 2; ++j) (*gradients)(j, columns.rows()) = -left_[j].dot(by_kappa);
  return true;
}

bool PairProblem::eigenvalues(const Vector& u, const Vector& p, const Regime& regime,
                              ComplexVector& values) const {
  const BasePoint point = split(u, p, regime);
  if (!base().eigenvalues(point.unknowns, point.parameters, regime, values)) return false;
  const Complex own = eigenvalue(point);
  remove_nearest(values, own);
  remove_nearest(values, -own);
  return true;
}

}  // namespace arcslip::continuation
