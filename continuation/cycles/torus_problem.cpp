#include "arcslip/continuation/cycles/torus_problem.hpp"

#include <algorithm>
#include <cmath>

#include "arcslip/continuation/linear/borders.hpp"

namespace arcslip::continuation {

TorusProblem::TorusProblem(const CycleProblem& base, Index active)
    : ExtendedProblem(base, active, 2),
      unknowns_(base.field().size()),
      count_(base.size() - (base.has_duration() ? 1 : 0)),
      solver_(make_bordered_solver(2 * count_, 2, true)),
      column_(spread(2 * count_, 1)),
      row_(spread(2 * count_, 2)),
      second_(base),
      right_(2 * count_ + 2),
      left_{right_, right_} {}

/// J_z in real form.
void TorusProblem::assemble(double kappa) const {
  const SparseMatrix& whole = at_.sparse_jacobian();
  const Index ends = count_ - unknowns_;
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(static_cast<std::size_t>(2 * whole.nonZeros()));
  for (Index column = 0; column < count_; ++column) {
    for (SparseMatrix::InnerIterator entry(whole, column); entry && entry.row() < count_; ++entry) {
      const auto add = [&](Index row_part, Index column_part, double factor) {
        entries.emplace_back(static_cast<int>(row_part * count_ + entry.row()),
                             static_cast<int>(column_part * count_ + column), factor * entry.value());
      };
      if (column < unknowns_ && entry.row() >= ends) {
        add(0, 1, -1);
        add(1, 0, 1);
        add(1, 1, 2 * kappa);
      } else {
        add(0, 0, 1);
        add(1, 1, 1);
      }
    }
  }
  doubled_.resize(2 * count_, 2 * count_);
  doubled_.setFromTriplets(entries.begin(), entries.end());
}

bool TorusProblem::solve_borders(double kappa) const {
  assemble(kappa);
  Vector twice(2 * count_);
  twice << scale_.head(count_), scale_.head(count_);
  solver_->set_jacobian(doubled_, twice);
  const auto first = column_.head(count_);
  const auto second = column_.tail(count_);
  solver_->columns() << first, -second, second, first + 2 * kappa * second;
  const auto of_first = row_.head(count_).transpose();
  const auto of_second = row_.tail(count_).transpose();
  solver_->rows() << of_first, -of_second, of_second, of_first + 2 * kappa * of_second;
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

bool TorusProblem::adapt(const BasePoint& point) {
  if (!ExtendedProblem::adapt(point)) return false;
  const double size = column_size(at_, scale_);
  const double twice = 2 * point.extras(0);
  for (int i = 0; i < 3; ++i) {  // inverse iteration, with the conjugates of both null vectors
    if (!solve_borders(point.extras(0))) return false;
    const Vector other = left_[0].segment(count_, count_);
    column_ << left_[0].head(count_) - twice * other, other;
    column_ *= size / column_.norm();
    row_ << right_.head(count_) + twice * right_.segment(count_, count_), -right_.segment(count_, count_);
    row_.normalize();
  }
  column_ *= steepness(point);
  return true;
}

void TorusProblem::each_border(const std::function<void(double*, Index)>& use) {
  ExtendedProblem::each_border(use);
  use(column_.data(), column_.size());
  use(row_.data(), row_.size());
  use(&second_.memory(), 1);
}

double TorusProblem::strain() const {
  return std::max(right_.head(2 * count_).norm(), left_[0].head(2 * count_).norm() * column_.norm());
}

bool TorusProblem::conditions(const BasePoint& point, Vector& values, Matrix* gradients) const {
  if (!solve_borders(point.extras(0))) return false;
  values = right_.tail(2);
  if (gradients == nullptr) return true;
  const Vector none = Vector::Zero(point.parameters.size());
  gradients->setZero();
  Matrix weights(base().size(), 2);
  Matrix columns;
  for (const Index part : {0, 1}) {
    for (Index j = 0; j < 2; ++j)
      weights.col(j) = padded(left_[j].segment(part * count_, count_), base().size());
    const Vector v = right_.segment(part * count_, count_).cwiseProduct(scale_.head(count_));
    if (!second_.contract(point.unknowns, point.parameters, point.regime, weights, padded(v, base().size()),
                          none, columns))
      return false;
    gradients->leftCols(columns.rows()) -= columns.transpose();
  }
  // what kappa moves: 2 z u(0), in the second part alone, and the same of both borders
  const Index ends = count_ - unknowns_;
  const auto second = right_.segment(count_, count_);
  Vector by_kappa = Vector::Zero(2 * count_ + 2);
  for (Index column = 0; column < unknowns_; ++column) {
    for (SparseMatrix::InnerIterator entry(at_.sparse_jacobian(), column); entry; ++entry) {
      if (entry.row() >= ends && entry.row() < count_)
        by_kappa(count_ + entry.row()) += 2 * entry.value() * scale_(column) * second(column);
    }
  }
  by_kappa.segment(count_, count_) += 2 * right_(2 * count_ + 1) * column_.tail(count_);
  by_kappa(2 * count_ + 1) = 2 * row_.tail(count_).dot(second);
  for (Index j = 0; j < 2; ++j) (*gradients)(j, columns.rows()) = -left_[j].dot(by_kappa);
  return true;
}

void TorusProblem::test(const Vector& u, const Vector& /*p*/, const Regime& /*regime*/,
                        Vector& values) const {
  values.resize(2);
  values << u(u.size() - 1) - 1, u(u.size() - 1) + 1;
}

std::vector<Observable> TorusProblem::observables() const {
  std::vector<Observable> result = ExtendedProblem::observables();
  result.push_back({"angle"});
  return result;
}

void TorusProblem::observe(const Vector& u, const Vector& p, const Regime& regime, Vector& values) const {
  Vector of_base;
  ExtendedProblem::observe(u, p, regime, of_base);
  values.resize(of_base.size() + 1);
  values << of_base, std::acos(std::clamp(u(u.size() - 1), -1.0, 1.0));
}

}  // namespace arcslip::continuation
