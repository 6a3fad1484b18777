// The response of the damper to a base that moves as if alone.

#include "arcslip/problems/response/harmonic_response.hpp"
#include "arcslip/problems/response/one_way_response.hpp"
#include "cases/built.hpp"

namespace arcslip {
namespace {

Built build_one_way(const ProblemRequest& request) {
  if (needs_balance(request.system, request.harmonics_tolerance))
    return built_in_harmonics(
        std::make_shared<const problems::HarmonicResponse>(build_harmonic_system(request.system)));
  return built_of_one_contact(std::make_shared<const problems::OneWayResponse>(build_system(request.system)),
                              "eta");
}

}  // namespace

ResponseKind one_way_response() {
  return {.name = "one_way",
          .title = "one-way responses",
          .parameters = forced_parameters(),
          .frequency = ResponseKind::Frequency::parameter,
          .extremum = "Y",
          .one_way = true,
          .not_disturbed = "whose base no disturbance of the damper moves",
          .not_proven = "from which the base's compliance, part of what it encloses, is left out",
          .remark = "base as if alone",
          .build = build_one_way};
}

}  // namespace arcslip
