#include "arcslip/continuation/points/singular_problem.hpp"

#include <algorithm>
#include <limits>

#include "arcslip/continuation/linear/borders.hpp"

namespace arcslip::continuation {

SingularProblem::SingularProblem(const Problem& base, Index active, Index count)
    : ExtendedProblem(base, active, 1),
      count_(count),
      second_(base),
      right_(count + 1),
      left_(count + 1),
      solver_(make_bordered_solver(count, 1, base.sparse())),
      column_(spread(count, 1)),
      row_(spread(count, 2)) {}

/// Where a second eigenvalue vanishes to the last digit, what is found is that of a point beside, as rounding
/// makes it nearly everywhere.
bool SingularProblem::solve_borders() const {
  solver_->columns().col(0) = column_;
  solver_->rows().row(0) = row_.transpose();
  solver_->corner()(0, 0) = 0;
  fill(*solver_, 0);
  if (solver_->factor() == 0) {
    fill(*solver_, std::numeric_limits<double>::epsilon() * column_size(at_, scale_));
    if (solver_->factor() == 0) return false;
  }
  right_.setUnit(count_);
  solver_->solve(right_);
  left_.setUnit(count_);
  solver_->solve_transposed(left_);
  return right_.allFinite() && left_.allFinite();
}

bool SingularProblem::adapt(const BasePoint& point) {
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

void SingularProblem::each_border(const std::function<void(double*, Index)>& use) {
  ExtendedProblem::each_border(use);
  use(column_.data(), column_.size());
  use(row_.data(), row_.size());
  use(&second_.memory(), 1);
}

double SingularProblem::strain() const {
  return std::max(right_.head(count_).norm(), left_.head(count_).norm() * column_.norm());
}

bool SingularProblem::conditions(const BasePoint& point, Vector& values, Matrix* gradients) const {
  if (!solve_borders()) return false;
  values(0) = right_(count_);
  if (gradients == nullptr) return true;
  Vector row;
  const Vector none = Vector::Zero(point.parameters.size());
  if (!second_.contract(point.unknowns, point.parameters, point.regime,
                        padded(left_.head(count_), base().size()), right_null(), none, row))
    return false;
  gradients->row(0) = -row.transpose();
  return true;
}

Vector SingularProblem::right_null() const {
  return padded(scale_.head(count_).cwiseProduct(right_.head(count_)), base().size());
}

bool SingularProblem::eigenvalues(const Vector& u, const Vector& p, const Regime& regime,
                                  ComplexVector& values) const {
  const BasePoint point = split(u, p, regime);
  if (!base().eigenvalues(point.unknowns, point.parameters, regime, values)) return false;
  remove_zero(values);
  return true;
}

}  // namespace arcslip::continuation
