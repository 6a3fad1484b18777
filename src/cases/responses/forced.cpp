#include "arcslip/problems/response/forced_response.hpp"

#include "arcslip/problems/response/floquet_response.hpp"
#include "cases/built.hpp"

namespace arcslip {
namespace {

Built build_forced(const ProblemRequest& request) {
  if (request.stability) {
    const auto problem = problems::build_floquet_response(request.system);
    Built built = built_in_harmonics<problems::HarmonicResponse>(problem);
    built.disturbed = problem;
    return built;
  }
  if (needs_balance(request.system, request.harmonics_tolerance))
    return built_in_harmonics(
        std::make_shared<const problems::HarmonicResponse>(build_harmonic_system(request.system)));
  const auto problem = std::make_shared<const problems::ForcedResponse>(build_system(request.system));
  Built built = built_of_one_contact(problem, "eta");
  built.enclosed = problem;
  return built;
}

}  // namespace

ResponseKind forced_response() {
  return {.name = "forced",
          .title = "forced responses",
          .parameters = forced_parameters(),
          .frequency = ResponseKind::Frequency::parameter,
          .extremum = "Y",
          .in_time = true,
          .not_disturbed = "",
          .not_proven = "",
          .remark = "",
          .build = build_forced};
}

}  // namespace arcslip
