#include "arcslip/problems/response/one_way_response.hpp"

#include <cmath>
#include <utility>

namespace arcslip::problems {
namespace {

FrictionSystem with_unyielding_base(FrictionSystem system) {
  system.base = system.base.unyielding();
  return system;
}

}  // namespace

OneWayResponse::OneWayResponse(FrictionSystem system)
    : ForcedResponse(with_unyielding_base(std::move(system))) {}

double OneWayResponse::observe(const Vector& /*u*/, const Vector& p, int /*regime*/, Index /*which*/,
                               continuation::Gradient& gradient) const {
  const ContactResponse base = system_.base.at(p(eta));
  const double value = std::abs(base.free);
  gradient.unknowns.setZero();
  gradient.parameters.setZero();
  gradient.parameters(eta) = value * log_free_by_eta(base);
  return value;
}

}  // namespace arcslip::problems
