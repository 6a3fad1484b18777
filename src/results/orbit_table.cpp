#include "results/orbit_table.hpp"

#include <fmt/compile.h>

#include <iterator>

#include "arcslip/continuation/cycles/cycle_problem.hpp"

namespace arcslip {
namespace {

using continuation::CycleProblem;

const CycleProblem* cycles(const TracedBranch& traced) {
  return traced.curve ? nullptr : dynamic_cast<const CycleProblem*>(traced.base.problem.get());
}

}  // namespace

std::string orbits_header(const TracedBranch& traced) {
  std::string text = "branch,point,type,t";
  if (const CycleProblem* problem = cycles(traced)) {
    for (const std::string& name : problem->field().names()) text += "," + name;
  }
  return text + "\n";
}

std::string orbit_rows(std::size_t number, const TracedBranch& traced) {
  const CycleProblem* problem = cycles(traced);
  fmt::memory_buffer text;
  if (problem == nullptr) return "";
  for (std::size_t i = 0; i < traced.branch.points.size(); ++i) {
    const continuation::BranchPoint& point = traced.branch.points[i];
    if (point.type == continuation::PointType::regular) continue;
    const continuation::OrbitMesh& mesh = problem->frame(point.regime).mesh;
    const auto orbit = problem->orbit(point.unknowns);
    const double duration = problem->duration(point.unknowns, point.parameters);
    for (Index node = 0; node < orbit.cols(); ++node) {
      const auto out = std::back_inserter(text);
      fmt::format_to(out, FMT_COMPILE("{},{},{},{}"), number, i, point.type_name(),
                     duration * mesh.place(node));
      for (const double value : orbit.col(node)) fmt::format_to(out, FMT_COMPILE(",{}"), value);
      text.push_back('\n');
    }
  }
  return fmt::to_string(text);
}

}  // namespace arcslip
