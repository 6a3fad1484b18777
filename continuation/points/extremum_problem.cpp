#include "arcslip/continuation/points/extremum_problem.hpp"

#include <cmath>
#include <limits>

#include "arcslip/continuation/linear/borders.hpp"

namespace arcslip::continuation {

ExtremumProblem::ExtremumProblem(const Problem& base, Index active, Index observable)
    : ExtendedProblem(base, active, 1),
      observable_(observable),
      solver_(make_bordered_solver(base.size(), 1, base.sparse())),
      row_(spread(base.size() + 1, 2)),
      second_(base),
      tangent_(base.size() + 1),
      adjoint_(base.size() + 1) {
  slope_.unknowns.setZero(base.size());
  slope_.parameters.setZero(static_cast<Index>(base.parameter_names().size()));
}

bool ExtremumProblem::solve_tangent(const BasePoint& point) const {
  const Index n = base().size();
  at_.fill(*solver_, scale_);
  solver_->columns().col(0) = at_.parameter_jacobian().col(active()) * active_scale_;
  solver_->rows().row(0) = row_.head(n).transpose();
  solver_->corner()(0, 0) = row_(n);
  if (solver_->factor() == 0) return false;
  tangent_.setUnit(n);
  solver_->solve(tangent_);
  base().observe(point.unknowns, point.parameters, point.regime, observable_, slope_);
  adjoint_.head(n) = slope_.unknowns.cwiseProduct(scale_) / size_;
  adjoint_(n) = slope_.parameters(active()) * active_scale_ / size_;
  return tangent_.allFinite() && adjoint_.allFinite();
}

bool ExtremumProblem::adapt(const BasePoint& point) {
  if (!ExtendedProblem::adapt(point)) return false;
  Vector unknown_scale(base().size());
  Vector parameter_scale(point.parameters.size());
  base().scale(point.unknowns, point.parameters, unknown_scale, parameter_scale);
  active_scale_ = parameter_scale(active());
  size_ = std::abs(base().observe(point.unknowns, point.parameters, point.regime, observable_, slope_));
  if (!(size_ > 0)) size_ = 1;
  if (!solve_tangent(point)) return false;
  row_ = tangent_.normalized();
  size_ *= steepness(point);
  return true;
}

void ExtremumProblem::each_border(const std::function<void(double*, Index)>& use) {
  ExtendedProblem::each_border(use);
  use(row_.data(), row_.size());
  use(&active_scale_, 1);
  use(&size_, 1);
  use(&second_.memory(), 1);
}

double ExtremumProblem::strain() const { return tangent_.norm(); }

bool ExtremumProblem::conditions(const BasePoint& point, Vector& values, Matrix* gradients) const {
  if (!solve_tangent(point)) return false;
  const Index n = base().size();
  values(0) = adjoint_.dot(tangent_);
  if (gradients == nullptr) return true;
  solver_->solve_transposed(adjoint_);
  const Vector du = scale_.cwiseProduct(tangent_.head(n));
  Vector dp = Vector::Zero(point.parameters.size());
  dp(active()) = active_scale_ * tangent_(n);
  Vector row;
  if (!second_.contract(point.unknowns, point.parameters, point.regime, adjoint_.head(n), du, dp, row))
    return false;
  Vector bend;
  const auto slope_at = [&](double h, Vector& out) {
    base().observe(point.unknowns + h * du, point.parameters + h * dp, point.regime, observable_, slope_);
    out.resize(n + dp.size());
    out << slope_.unknowns, slope_.parameters;
    return out.allFinite();
  };
  const double step = 0.02 / second_.length(point.unknowns, point.parameters, du, dp);
  if (!std::isfinite(differentiate(slope_at, step, bend).error)) return false;
  gradients->row(0) = (bend / size_ - row).transpose();
  return true;
}

double ExtremumProblem::bend(const BasePoint& point) const {
  const Index n = base().size();
  Vector slope(1);
  Matrix gradient(1, n + point.parameters.size());
  if (!conditions(point, slope, &gradient)) return std::nan("");
  const double along = gradient.row(0).head(n).dot(scale_.cwiseProduct(tangent_.head(n))) +
                       gradient(0, n + active()) * active_scale_ * tangent_(n);
  return size_ * along / tangent_.squaredNorm();
}

}  // namespace arcslip::continuation
