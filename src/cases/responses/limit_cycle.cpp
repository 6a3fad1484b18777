// Vibration that the base's negative damping keeps up.

#include "arcslip/problems/response/limit_cycle.hpp"

#include "arcslip/problems/response/floquet_response.hpp"
#include "cases/built.hpp"

namespace arcslip {
namespace {

Built build_limit_cycle(const ProblemRequest& request) {
  if (request.stability) {
    const auto problem = problems::build_floquet_cycle(request.system);
    Built built = built_in_harmonics<problems::HarmonicCycle>(problem);
    built.disturbed = problem;
    return built;
  }
  if (needs_balance(request.system, request.harmonics_tolerance))
    return built_in_harmonics(
        std::make_shared<const problems::HarmonicCycle>(build_harmonic_system(request.system)));
  return built_of_one_contact(std::make_shared<const problems::LimitCycle>(build_system(request.system)),
                              "zeta_B");
}

}  // namespace

ResponseKind limit_cycle_response() {
  return {.name = "limit_cycle",
          .title = "limit cycles",
          .parameters = free_parameters("zeta_B"),
          .frequency = ResponseKind::Frequency::own,
          .extremum = "",
          .not_disturbed = "",
          .not_proven = "whose frequency is a second unknown",
          .remark = "limit cycle",
          .build = build_limit_cycle};
}

}  // namespace arcslip
