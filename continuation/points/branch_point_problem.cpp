#include "arcslip/continuation/points/branch_point_problem.hpp"

#include <Eigen/QR>
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

namespace {

Matrix orthonormal(const Matrix& columns) {
  return Eigen::HouseholderQR<Matrix>(columns).householderQ() *
         Matrix::Identity(columns.rows(), columns.cols());
}

}  // namespace

bool DoublePoint::solve_borders() {
  linear_.fill(*solver_, scale_.head(n_));
  solver_->columns() << linear_.parameter_jacobian().col(active_) * scale_(n_), columns_;
  solver_->rows() = border_.topRows(n_).transpose();
  solver_->corner().setZero();
  solver_->corner().col(0) = border_.row(n_).transpose();
  if (solver_->factor() == 0) return false;
  left_.resize(n_, 2);
  right_.resize(n_ + 1, 3);
  conditions_.resize(2, 3);
  Vector side;
  for (Index j = 0; j < 3; ++j) {
    side = Vector::Unit(n_ + 3, n_ + j);
    solver_->solve(side);
    right_.col(j) = side.head(n_ + 1);
    conditions_.col(j) = side.tail(2);
    if (j == 0) continue;
    side = Vector::Unit(n_ + 3, n_ + j);
    solver_->solve_transposed(side);
    left_.col(j - 1) = side.head(n_);
  }
  return left_.allFinite() && right_.allFinite();
}

bool DoublePoint::settle() {
  if (!linear_.evaluate(at_.unknowns, at_.parameters, at_.regime)) return false;
  Vector unknowns(n_);
  Vector all(at_.parameters.size());
  problem_.scale(at_.unknowns, at_.parameters, unknowns, all);
  scale_ << unknowns, all(active_);
  size_ = column_size(linear_, unknowns);
  left_.resize(n_, 2);
  right_.resize(n_ + 1, 3);
  for (int j = 0; j < 2; ++j) left_.col(j) = spread(n_, 1 + 2 * j);
  for (int j = 0; j < 3; ++j) right_.col(j) = spread(n_ + 1, 2 + 2 * j);
  for (int i = 0; i < 4; ++i) {  // inverse iteration
    columns_ = size_ * orthonormal(left_);
    border_ = orthonormal(right_);
    if (!solve_borders()) return false;
  }
  return true;
}

/// A solution with a right-hand side without preference is as long as the inverse is large.
double DoublePoint::away_from_more() const {
  Vector side = spread(n_ + 3, 1);
  side.head(n_) *= size_;
  solver_->solve(side);
  return 1 / (side.norm() * largest_slope());
}

bool DoublePoint::rows(const Vector& d, double h, Matrix& out) {
  const Vector dp = parameters(d(n_));
  Matrix all;
  if (!second_.contract(at_.unknowns + h * d.head(n_), at_.parameters + h * dp, at_.regime, left_, d.head(n_),
                        dp, all))
    return false;
  out.resize(n_ + 1, 2);
  out << all.topRows(n_), all.row(n_ + active_);
  out = scale_.asDiagonal() * out;
  return out.allFinite();
}

bool DoublePoint::set_forms() {
  for (Index j = 0; j < 3; ++j) {
    Matrix row;
    if (!rows(scale_.cwiseProduct(right_.col(j)), 0, row)) return false;
    for (std::size_t i = 0; i < 2; ++i)
      forms_[i].row(j) = row.col(static_cast<Index>(i)).transpose() * right_;
  }
  for (Eigen::Matrix3d& form : forms_) form = 0.5 * (form + form.transpose().eval());
  return true;
}

void DoublePoint::correct() {
  Matrix gradients(6, 3);
  gradients << forms_[0], forms_[1];
  Vector values(6);
  values << conditions_.row(0).transpose(), conditions_.row(1).transpose();
  Vector correction = Vector::Zero(n_ + 3);
  correction.head(n_) = -linear_.residual();
  solver_->solve(correction);
  const Vector along = gradients.completeOrthogonalDecomposition().solve(values);
  const Vector all = scale_.cwiseProduct(correction.head(n_ + 1) + right_ * along);
  at_.unknowns += all.head(n_);
  at_.parameters(active_) += all(n_);
}

Eigen::Vector2d DoublePoint::cubic(const Eigen::Vector3d& y) {
  const Eigen::Vector2d none = Eigen::Vector2d::Constant(std::nan(""));
  const Vector d = direction(y);
  const Vector dp = parameters(d(n_));
  const double step = 0.02 / second_.length(at_.unknowns, at_.parameters, d.head(n_), dp);
  Vector bend;
  const auto first_at = [&](double h, Vector& out) {
    if (!linear_.evaluate(at_.unknowns + h * d.head(n_), at_.parameters + h * dp, at_.regime)) return false;
    out.resize(n_);
    linear_.multiply(d.head(n_), out);
    out += linear_.parameter_jacobian().col(active_) * d(n_);
    return true;
  };
  Matrix row;
  Vector third;
  const auto second_at = [&](double h, Vector& out) {
    if (!rows(d, h, row)) return false;
    out = row.transpose() * d.cwiseQuotient(scale_);
    return true;
  };
  if (!std::isfinite(differentiate(first_at, step, bend).error) ||
      !std::isfinite(differentiate(second_at, step, third).error) || !rows(d, 0, row))
    return none;
  Vector response = Vector::Zero(n_ + 3);
  response.head(n_) = -bend;
  solver_->solve(response);
  return (third + 3 * row.transpose() * response.head(n_ + 1)) / 6;
}

}  // namespace arcslip::continuation
