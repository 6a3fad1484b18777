#include "arcslip/continuation/points/border_problem.hpp"

namespace arcslip::continuation {

BorderProblem::BorderProblem(const Problem& base, Index active, int border)
    : ExtendedProblem(base, active, 1), border_(border) {
  slope_.unknowns.setZero(base.size());
  slope_.parameters.setZero(static_cast<Index>(base.parameter_names().size()));
}

double BorderProblem::border(const Vector& u, const Vector& p, const Regime& regime, int border,
                             Gradient* gradient) const {
  return ExtendedProblem::border(u, p, regime, border < border_ ? border : border + 1, gradient);
}

bool BorderProblem::conditions(const BasePoint& point, Vector& values, Matrix* gradients) const {
  values(0) = base().border(point.unknowns, point.parameters, point.regime, border_, &slope_);
  if (gradients == nullptr) return true;
  gradients->row(0) << slope_.unknowns.transpose(), slope_.parameters.transpose();
  return true;
}

}  // namespace arcslip::continuation
