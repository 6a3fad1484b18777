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

}  // namespace arcslip::problems
