#include "arcslip/problems/library/named_unknowns.hpp"

namespace arcslip::problems {

std::vector<continuation::Observable> NamedUnknowns::observables() const {
  std::vector<continuation::Observable> result;
  result.reserve(unknowns_.size());
  for (const std::string& name : unknowns_) result.push_back({name, true});
  return result;
}

void NamedUnknowns::observe(const Vector& u, const Vector& /*p*/, const continuation::Regime& /*regime*/,
                            Vector& values) const {
  values = u;
}

double NamedUnknowns::observe(const Vector& u, const Vector& /*p*/, const continuation::Regime& /*regime*/,
                              Index which, continuation::Gradient& gradient) const {
  gradient.unknowns.setUnit(which);
  gradient.parameters.setZero();
  return u(which);
}

}  // namespace arcslip::problems
