#include "arcslip/continuation/points/branch_point_problem.hpp"

#include <algorithm>
#include <cmath>

#include "arcslip/continuation/linear/borders.hpp"

namespace arcslip::continuation {

BranchPointProblem::BranchPointProblem(const Problem& base, Index active)
    : ExtendedProblem(base, active, 2),
      solver_(make_bordered_solver(base.size(), 2, base.sparse())),
      rows_(base.size() + 1, 2),
      second_(base),
      left_(base.size() + 2),
      right_{Vector(base.size() + 2), Vector(base.size() + 2)} {
  unfolding_ = spread(base.size(), 1);
  rows_.col(0) = spread(base.size() + 1, 2);
  rows_.col(1) = spread(base.size() + 1, 4);
}

bool BranchPointProblem::solve_borders() const {
  const Index n = base().size();
  at_.fill(*solver_, scale_);
  solver_->columns().col(0) = at_.parameter_jacobian().col(active()) * active_scale_;
  solver_->columns().col(1) = unfolding_;
  solver_->rows() = rows_.topRows(n).transpose();
  solver_->corner().col(0) = rows_.row(n).transpose();
  solver_->corner().col(1).setZero();
  if (solver_->factor() == 0) return false;
  left_.setUnit(n + 1);
  solver_->solve_transposed(left_);
  for (Index j = 0; j < 2; ++j) {
    right_[j].setUnit(n + j);
    solver_->solve(right_[j]);
  }
  return left_.allFinite() && right_[0].allFinite() && right_[1].allFinite();
}

bool BranchPointProblem::adapt(const BasePoint& point) {
  if (!ExtendedProblem::adapt(point)) return false;
  const Index n = base().size();
  Vector unknown_scale(n);
  Vector parameter_scale(point.parameters.size());
  base().scale(point.unknowns, point.parameters, unknown_scale, parameter_scale);
  active_scale_ = parameter_scale(active());
  const double size = column_size(at_, scale_);
  for (int i = 0; i < 3; ++i) {  // inverse iteration
    if (!solve_borders()) return false;
    unfolding_ = left_.head(n) * (size / left_.head(n).norm());
    rows_.col(0) = right_[0].head(n + 1).normalized();
    rows_.col(1) = right_[1].head(n + 1);
    rows_.col(1) -= rows_.col(0).dot(rows_.col(1)) * rows_.col(0);
    rows_.col(1).normalize();
    if (!rows_.allFinite()) return false;
  }
  unfolding_ *= steepness(point);
  return solve_borders();
}

void BranchPointProblem::each_border(const std::function<void(double*, Index)>& use) {
  ExtendedProblem::each_border(use);
  use(rows_.data(), rows_.size());
  use(&active_scale_, 1);
  use(&second_.memory(), 1);
}

double BranchPointProblem::strain() const {
  const Index n = base().size();
  return std::max(
      {left_.head(n).norm() * unfolding_.norm(), right_[0].head(n + 1).norm(), right_[1].head(n + 1).norm()});
}

bool BranchPointProblem::conditions(const BasePoint& point, Vector& values, Matrix* gradients) const {
  if (!solve_borders()) return false;
  const Index n = base().size();
  values = left_.tail(2);
  if (gradients == nullptr) return true;
  Vector row;
  for (Index j = 0; j < 2; ++j) {
    Vector dp = Vector::Zero(point.parameters.size());
    dp(active()) = active_scale_ * right_[j](n);
    if (!second_.contract(point.unknowns, point.parameters, point.regime, left_.head(n),
                          scale_.cwiseProduct(right_[j].head(n)), dp, row)) {
      return false;
    }
    gradients->row(j).head(row.size()) = -row.transpose();
    gradients->row(j).tail(1).setZero();
  }
  return true;
}

Vector BranchPointProblem::null_scale() const {
  Vector scale(scale_.size() + 1);
  scale << scale_, active_scale_;
  return scale;
}

Matrix BranchPointProblem::null_space() const {
  Matrix basis(scale_.size() + 1, 2);
  basis << right_[0].head(basis.rows()), right_[1].head(basis.rows());
  return null_scale().asDiagonal() * basis;
}

}  // namespace arcslip::continuation
