#include "results/sector_table.hpp"

#include <fmt/format.h>

#include <cmath>
#include <iterator>

#include "arcslip/problems/response/contact_problem.hpp"
#include "arcslip/problems/response/sector_motions.hpp"

namespace arcslip {
namespace {

using problems::HarmonicResponse;

const HarmonicResponse* whole_response(const TracedBranch& traced) {
  const auto* response = dynamic_cast<const HarmonicResponse*>(traced.base.problem.get());
  return response != nullptr && response->system().sectors > 1 && !traced.curve ? response : nullptr;
}

void add_rows(const HarmonicResponse& problem, const continuation::BranchPoint& point,
              const std::string& begin, std::string& text) {
  const continuation::Guess at{point.unknowns, point.parameters, point.regime, {}};
  const problems::SectorMotions motions = problems::sector_motions(problem, at);
  const Index each = motions.base.rows();
  for (Index i = 0; i < motions.base.cols(); ++i) {
    for (Index j = 0; j < each; ++j) {
      const Complex r = motions.relative(j, i);
      const Complex y = motions.base(j, i);
      const Complex u = motions.damper(j, i);
      const Index contact = i * each + j;
      const bool rubs = problem.system().contacts[static_cast<std::size_t>(contact)].stiffness > 0;
      const double threshold = rubs ? problem.slip_threshold(contact, point.parameters) : std::nan("");
      const char* const state = !rubs ? "none" : point.regime[contact] != 0 ? "slip" : "stick";
      fmt::format_to(std::back_inserter(text),
                     "{},{},{},{},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g}", begin, i + 1,
                     j + 1, state, std::abs(r), std::abs(r) / threshold, std::abs(y), std::abs(u),
                     problems::lag(y), problems::lag(u), problems::lag(r));
      for (Index k = 0; k < motions.outputs.rows(); ++k)
        fmt::format_to(std::back_inserter(text), ",{:.17g}", std::abs(motions.outputs(k, i)));
      text += "\n";
    }
  }
}

}  // namespace

std::string sectors_header(const TracedBranch& traced) {
  std::string text = "branch,point,type,eta,P,sector,contact,state,R,R_over_S,Y,U,beta,alpha,psi";
  const HarmonicResponse* problem = whole_response(traced);
  if (problem != nullptr) {
    for (const ContactOutput& output : problem->system().outputs) text += "," + output.name;
  }
  return text + "\n";
}

std::string sector_rows(std::size_t number, const TracedBranch& traced) {
  const HarmonicResponse* problem = whole_response(traced);
  std::string text;
  if (problem == nullptr) return text;
  for (std::size_t i = 0; i < traced.branch.points.size(); ++i) {
    const continuation::BranchPoint& point = traced.branch.points[i];
    if (point.type == continuation::PointType::regular) continue;
    const std::string begin = fmt::format("{},{},{},{:.17g},{:.17g}", number, i, point.type_name(),
                                          point.parameters(0), point.parameters(1));
    add_rows(*problem, point, begin, text);
  }
  return text;
}

}  // namespace arcslip
