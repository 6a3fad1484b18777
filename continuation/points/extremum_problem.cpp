#include "arcslip/continuation/points/extremum_problem.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "arcslip/continuation/linear/borders.hpp"

namespace arcslip::continuation {

ExtremumProblem::ExtremumProblem(const Problem& base, Index active, Index observable)
    : ExtendedProblem(base, active, 1),
      observable_(observable),
      solver_(make_bordered_solver(base.size(), 2, base.sparse())),
      column_(spread(base.size() + 1, 1)),
      row_(spread(base.size() + 1, 2)),
      second_(base),
      right_(base.size() + 2),
      left_(base.size() + 2) {
  slope_.unknowns.setZero(base.size());
  slope_.parameters.setZero(static_cast<Index>(base.parameter_names().size()));
}

bool ExtremumProblem::solve_borders(const BasePoint& point) const {
  const Index n = base().size();
  base().observe(point.unknowns, point.parameters, point.regime, observable_, slope_);
  at_.fill(*solver_, scale_);
  solver_->columns() << at_.parameter_jacobian().col(active()) * active_scale_, column_.head(n);
  solver_->rows() << slope_.unknowns.cwiseProduct(scale_).transpose() / size_, row_.head(n).transpose();
  solver_->corner() << slope_.parameters(active()) * active_scale_ / size_, column_(n), row_(n), 0;
  if (solver_->factor() == 0) return false;
  right_.setUnit(n + 1);
  solver_->solve(right_);
  left_.setUnit(n + 1);
  solver_->solve_transposed(left_);
  return right_.allFinite() && left_.allFinite();
}

/// To the null vectors, by inverse iteration.
bool ExtremumProblem::fit_borders(const BasePoint& point) {
  const Index n = base().size() + 1;
  const double size = column_size(at_, scale_);
  for (int i = 0; i < 3; ++i) {
    if (!solve_borders(point)) return false;
    column_ = left_.head(n) * (size / left_.head(n).norm());
    row_ = right_.head(n).normalized();
  }
  return true;
}

bool ExtremumProblem::adapt(const BasePoint& point) {
  if (!ExtendedProblem::adapt(point)) return false;
  Vector unknown_scale(base().size());
  Vector parameter_scale(point.parameters.size());
  base().scale(point.unknowns, point.parameters, unknown_scale, parameter_scale);
  active_scale_ = parameter_scale(active());
  const double value =
      std::abs(base().observe(point.unknowns, point.parameters, point.regime, observable_, slope_));
  const Vector column = column_;
  const Vector row = row_;
  size_ = std::numeric_limits<double>::infinity();  // for the tangent of the branch alone
  double bent = 0;
  if (Vector change; fit_borders(point) && change_of_slope(point, change))
    bent = std::hypot(change.head(scale_.size()).cwiseProduct(scale_).norm(),
                      change(scale_.size() + active()) * active_scale_);
  constexpr double little = 1e-9;  // as a square next to where it vanishes
  size_ = value > little * bent ? value : bent;
  if (!(size_ > 0)) size_ = 1;
  column_ = column;
  row_ = row;
  if (!fit_borders(point)) return false;
  column_ *= steepness(point);
  return true;
}

void ExtremumProblem::each_border(const std::function<void(double*, Index)>& use) {
  ExtendedProblem::each_border(use);
  use(column_.data(), column_.size());
  use(row_.data(), row_.size());
  use(&active_scale_, 1);
  use(&size_, 1);
  use(&second_.memory(), 1);
}

double ExtremumProblem::strain() const {
  const Index n = base().size() + 1;
  return std::max(right_.head(n).norm(), left_.head(n).norm() * column_.norm());
}

/// The change of (u, p) along the tangent, a unit of its length.
void ExtremumProblem::along_tangent(Vector& du, Vector& dp) const {
  const Index n = base().size();
  du = scale_.cwiseProduct(right_.head(n));
  dp.setZero(slope_.parameters.size());
  dp(active()) = active_scale_ * right_(n);
}

/// d(grad Y) t over u and all parameters.
bool ExtremumProblem::change_of_slope(const BasePoint& point, Vector& out) const {
  Vector du;
  Vector dp;
  along_tangent(du, dp);
  const auto slope_at = [&](double h, Vector& slope) {
    base().observe(point.unknowns + h * du, point.parameters + h * dp, point.regime, observable_, slope_);
    slope.resize(du.size() + dp.size());
    slope << slope_.unknowns, slope_.parameters;
    return slope.allFinite();
  };
  const double step = 0.02 / second_.length(point.unknowns, point.parameters, du, dp);
  return std::isfinite(differentiate(slope_at, step, out).error);
}

/// Of g over u and all parameters: -(w, w_Y) d[F'; grad Y / size] t.
bool ExtremumProblem::gradient(const BasePoint& point, Vector& out) const {
  const Index n = base().size();
  Vector du;
  Vector dp;
  along_tangent(du, dp);
  Vector change;
  if (!second_.contract(point.unknowns, point.parameters, point.regime, left_.head(n), du, dp, out) ||
      !change_of_slope(point, change))
    return false;
  out = -out - left_(n) / size_ * change;
  return true;
}

bool ExtremumProblem::conditions(const BasePoint& point, Vector& values, Matrix* gradients) const {
  if (!solve_borders(point)) return false;
  values(0) = right_(base().size() + 1);
  if (gradients == nullptr) return true;
  Vector row;
  if (!gradient(point, row)) return false;
  gradients->row(0) = row.transpose();
  return true;
}

double ExtremumProblem::bend(const BasePoint& point) const {
  const Index n = base().size();
  Vector row;
  if (!solve_borders(point) || !gradient(point, row)) return std::nan("");
  const auto tangent = right_.head(n + 1);
  const double along =
      row.head(n).dot(scale_.cwiseProduct(tangent.head(n))) + row(n + active()) * active_scale_ * tangent(n);
  return -size_ * along / (left_(n) * tangent.squaredNorm());
}

}  // namespace arcslip::continuation
