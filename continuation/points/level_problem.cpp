#include "arcslip/continuation/points/level_problem.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace arcslip::continuation {

LevelProblem::LevelProblem(const Problem& base, Index active, Index observable, double value)
    : ExtendedProblem(base, active, 1),
      observable_(observable),
      what_(base.observables()[static_cast<std::size_t>(observable)]),
      value_(value) {
  if (!what_.has_gradient)
    throw std::invalid_argument("LevelProblem: " + what_.name + " is an observable without a gradient");
  slope_.unknowns.setZero(base.size());
  slope_.parameters.setZero(static_cast<Index>(base.parameter_names().size()));
}

bool LevelProblem::adapt(const BasePoint& point) {
  if (!ExtendedProblem::adapt(point)) return false;
  size_ = std::max(std::abs(value_), what_.scale);
  if (!(size_ > 0)) size_ = slope(point);  // what is to vanish has no size of its own
  size_ *= steepness(point);
  return true;
}

/// How much the observable changes over the base's scale.
double LevelProblem::slope(const BasePoint& point) {
  base().observe(point.unknowns, point.parameters, point.regime, observable_, slope_);
  Vector unknown_scale(base().size());
  Vector parameter_scale(point.parameters.size());
  base().scale(point.unknowns, point.parameters, unknown_scale, parameter_scale);
  const double slope = std::hypot(slope_.unknowns.cwiseProduct(unknown_scale).norm(),
                                  slope_.parameters(active()) * parameter_scale(active()));
  return slope > 0 ? slope : 1;
}

void LevelProblem::each_border(const std::function<void(double*, Index)>& use) {
  ExtendedProblem::each_border(use);
  use(&size_, 1);
}

bool LevelProblem::conditions(const BasePoint& point, Vector& values, Matrix* gradients) const {
  const double here = base().observe(point.unknowns, point.parameters, point.regime, observable_, slope_);
  values(0) = (what_.near(here, value_) - value_) / size_;
  if (gradients == nullptr) return true;
  gradients->row(0) << slope_.unknowns.transpose() / size_, slope_.parameters.transpose() / size_;
  return true;
}

}  // namespace arcslip::continuation
