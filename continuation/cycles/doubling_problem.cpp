#include "arcslip/continuation/cycles/doubling_problem.hpp"

#include <algorithm>

#include "arcslip/continuation/linear/borders.hpp"

namespace arcslip::continuation {

DoublingProblem::DoublingProblem(const CycleProblem& base, Index active)
    : ExtendedProblem(base, active, 1),
      unknowns_(base.field().size()),
      count_(base.size() - (base.has_duration() ? 1 : 0)),
      solver_(make_bordered_solver(count_, 1, true)),
      column_(spread(count_, 1)),
      row_(spread(count_, 2)),
      second_(base),
      right_(count_ + 1),
      left_(count_ + 1) {}

bool DoublingProblem::solve_borders() const {
  const SparseMatrix& whole = at_.sparse_jacobian();
  SparseMatrix twisted = whole.topLeftCorner(count_, count_);
  for (Index column = 0; column < unknowns_; ++column) {
    for (SparseMatrix::InnerIterator entry(twisted, column); entry; ++entry) {
      if (entry.row() >= count_ - unknowns_) entry.valueRef() *= -1;
    }
  }
  twisted.makeCompressed();
  solver_->set_jacobian(twisted, scale_);
  solver_->columns().col(0) = column_;
  solver_->rows().row(0) = row_.transpose();
  solver_->corner()(0, 0) = 0;
  if (solver_->factor() == 0) return false;
  right_.setUnit(count_);
  solver_->solve(right_);
  left_.setUnit(count_);
  solver_->solve_transposed(left_);
  return right_.allFinite() && left_.allFinite();
}

bool DoublingProblem::adapt(const BasePoint& point) {
  if (!ExtendedProblem::adapt(point)) return false;
  const double size = column_size(at_, scale_);
  for (int i = 0; i < 3; ++i) {  // inverse iteration
    if (!solve_borders()) return false;
    column_ = left_.head(count_) * (size / left_.head(count_).norm());
    row_ = right_.head(count_).normalized();
  }
  column_ *= steepness(point);
  return true;
}

void DoublingProblem::each_border(const std::function<void(double*, Index)>& use) {
  ExtendedProblem::each_border(use);
  use(column_.data(), column_.size());
  use(row_.data(), row_.size());
  use(&second_.memory(), 1);
}

double DoublingProblem::strain() const {
  return std::max(right_.head(count_).norm(), left_.head(count_).norm() * column_.norm());
}

Vector DoublingProblem::padded(const Vector& v) const {
  Vector result = Vector::Zero(base().size());
  result.head(count_) = v.head(count_);
  return result;
}

bool DoublingProblem::conditions(const BasePoint& point, Vector& values, Matrix* gradients) const {
  if (!solve_borders()) return false;
  values(0) = right_(count_);
  if (gradients == nullptr) return true;
  Vector row;
  const Vector none = Vector::Zero(point.parameters.size());
  // The ends are linear: what is differentiated is the same whether v returns or turns round.
  if (!second_.contract(point.unknowns, point.parameters, point.regime, padded(left_), padded(variation()),
                        none, row))
    return false;
  gradients->row(0) = -row.transpose();
  return true;
}

}  // namespace arcslip::continuation
