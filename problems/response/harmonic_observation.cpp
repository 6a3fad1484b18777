#include "harmonic_observation.hpp"

namespace arcslip::problems {

std::vector<continuation::Observable> HarmonicProblem::observables() const {
  std::vector<continuation::Observable> all;
  for (const Quantity& quantity : quantities_) {
    all.push_back({quantity.name, has_gradient(quantity.measure)});
    if (quantity.measure == Measure::lag) all.back() = angle(quantity.name);
  }
  return all;
}

void HarmonicProblem::observe(const Vector& u, const Vector& p, const continuation::Regime& regime,
                              Vector& values) const {
  values.resize(std::ssize(quantities_));
  Observation at_point(*this, u, p, regime, nullptr);
  for (std::size_t i = 0; i < quantities_.size(); ++i)
    values(static_cast<Index>(i)) = at_point.value(quantities_[i]);
}

double HarmonicProblem::observe(const Vector& u, const Vector& p, const continuation::Regime& regime,
                                Index which, continuation::Gradient& gradient) const {
  gradient.unknowns.setZero();
  gradient.parameters.setZero();
  return Observation(*this, u, p, regime, &gradient).value(quantities_[at(which)]);
}

}  // namespace arcslip::problems
