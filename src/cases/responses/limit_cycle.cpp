// Vibration that the base's negative damping keeps up.

#include "arcslip/problems/response/limit_cycle.hpp"

#include "arcslip/problems/response/harmonic_cycle.hpp"
#include "cases/built.hpp"

namespace arcslip {
namespace {

Built build_limit_cycle(const ProblemRequest& request) {
  if (needs_balance(request.system, request.harmonics_tolerance)) {
    const auto problem =
        std::make_shared<const problems::HarmonicCycle>(build_harmonic_system(request.system));
    return built_in_harmonics(problem);
  }
  const auto problem = std::make_shared<const problems::LimitCycle>(build_system(request.system));
  const auto guess = [problem](const Built::ValueOf& value, const continuation::TraceOptions& /*limits*/) {
    return problem->guess(value("zeta_B"), value("P"));
  };
  return {problem, guess};
}

}  // namespace

ResponseKind limit_cycle_response() {
  return {.name = "limit_cycle",
          .title = "limit cycles",
          .parameters = free_parameters("zeta_B"),
          .frequency = ResponseKind::Frequency::own,
          .extremum = "",
          .not_proven = "whose frequency is a second unknown",
          .remark = "limit cycle",
          .build = build_limit_cycle};
}

}  // namespace arcslip
