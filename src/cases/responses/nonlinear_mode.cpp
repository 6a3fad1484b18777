// A mode of vibration over its amplitude.

#include "arcslip/problems/response/nonlinear_mode.hpp"

#include "cases/built.hpp"

namespace arcslip {
namespace {

Built build_nonlinear_mode(const ProblemRequest& request) {
  const auto problem = std::make_shared<const problems::NonlinearMode>(build_harmonic_system(request.system));
  const auto guess = [problem](const Built::ValueOf& value, const continuation::TraceOptions& limits) {
    return problem->guess(value("eta"), values_of(*problem, value), limits);
  };
  return {problem, guess, problem->system().orders};
}

}  // namespace

ResponseKind nonlinear_mode_response() {
  return {.name = "nonlinear_mode",
          .title = "nonlinear modes",
          .parameters = free_parameters("R"),
          .frequency = ResponseKind::Frequency::guessed,
          .extremum = "zeta",
          .not_disturbed = "which a damping made up for them keeps periodic, and any disturbance with them",
          .not_proven = "whose frequency and damping are unknowns beside R",
          .remark = "nonlinear mode",
          .build = build_nonlinear_mode};
}

}  // namespace arcslip
