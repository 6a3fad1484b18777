#include "arcslip/cases/certification.hpp"

#include <fmt/format.h>

#include "arcslip/assembly/structures.hpp"
#include "arcslip/problems/response/forced_response.hpp"

namespace arcslip {

std::string why_not_certifiable(const CaseBranch& request) {
  const ProblemRequest& problem = request.problem;
  if (problem.model != nullptr)
    return fmt::format("the model {}, whose equations have no closed enclosure", problem.model->name);
  if (request.curve)
    return fmt::format("a curve of {} points, which has a second equation for what its points are",
                       request.curve->name);
  if (!problem.response->not_proven.empty())
    return fmt::format("{}, {}", problem.response->title, problem.response->not_proven);
  if (problem.stability)
    return "branches with stability: exponents are eigenvalues, which it would leave unproven beside them";
  if (problem.system.harmonics.size() > 1 || problem.harmonics_tolerance)
    return "several harmonics, each of which is a further complex unknown, and whose friction depends on "
           "turning points of r(t) that have no closed form";
  if (!structures_of(problem.system).is_one_contact(problem.system))
    return problem.system.contacts.size() > 1
               ? "several contacts, whose phases against each other are unknowns beside their amplitudes"
               : "the full path of a sector, whose compliance comes from sparse solves without an enclosure";
  if (!problem.system.varied.empty())
    return fmt::format("branches over {}: what it encloses is a function of eta and P",
                       problem.system.varied);
  if (problem.system.cubic_stiffness != 0)
    return "cubic springs, which make the amplitude of the base a second unknown";
  if (problem.system.has_others())
    return "elements beside the contacts, whose displacements are further unknowns";
  return "";
}

void certify(TracedBranch& traced) {
  const continuation::TraceOptions& options = traced.request->options;
  const auto parameter =
      options.parameter == "eta" ? problems::ForcedResponse::eta : problems::ForcedResponse::preload;
  traced.certificate = problems::certify(*traced.base.enclosed, traced.branch, parameter,
                                         {options.tolerance, options.max_step, options.go_on});
}

}  // namespace arcslip
