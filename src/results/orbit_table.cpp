#include "results/orbit_table.hpp"

#include <fmt/compile.h>

#include <iterator>

#include "arcslip/continuation/cycles/orbit_problem.hpp"
#include "cases/cycles.hpp"

namespace arcslip {

using continuation::OrbitProblem;

std::string orbits_header(const TracedBranch& traced) {
  std::string text = "branch,point,type";
  if (const OrbitProblem* problem = orbits_of(traced)) {
    text += "," + problem->time_name();
    for (const std::string& name : problem->told_names()) text += "," + name;
  }
  return text + "\n";
}

std::string orbit_rows(std::size_t number, const TracedBranch& traced) {
  const OrbitProblem* problem = orbits_of(traced);
  fmt::memory_buffer text;
  if (problem == nullptr) return "";
  for (std::size_t i = 0; i < traced.branch.points.size(); ++i) {
    const continuation::BranchPoint& point = traced.branch.points[i];
    if (point.type == continuation::PointType::regular) continue;
    const Matrix orbit = problem->told_orbit(point.unknowns);
    const Vector times = problem->times(point.unknowns, point.parameters, point.regime);
    for (Index node = 0; node < orbit.cols(); ++node) {
      const auto out = std::back_inserter(text);
      fmt::format_to(out, FMT_COMPILE("{},{},{},{}"), number, i, point.type_name(), times(node));
      for (const double value : orbit.col(node)) fmt::format_to(out, FMT_COMPILE(",{}"), value);
      text.push_back('\n');
    }
  }
  return fmt::to_string(text);
}

std::string tori_header(const TracedBranch& traced) {
  std::string text = "branch,point,type,theta_1,theta_2";
  if (const continuation::Torus* problem = torus_of(traced)) {
    for (const std::string& name : problem->field().names()) text += "," + name;
  }
  return text + "\n";
}

std::string torus_rows(std::size_t number, const TracedBranch& traced) {
  const continuation::Torus* problem = torus_of(traced);
  if (problem == nullptr) return "";
  fmt::memory_buffer text;
  for (std::size_t i = 0; i < traced.branch.points.size(); ++i) {
    const continuation::BranchPoint& point = traced.branch.points[i];
    if (point.type == continuation::PointType::regular) continue;
    const auto values = problem->values(point.unknowns);
    for (Index at = 0; at < values.cols(); ++at) {
      const auto out = std::back_inserter(text);
      fmt::format_to(out, FMT_COMPILE("{},{},{},{},{}"), number, i, point.type_name(),
                     problem->angle(0, at % problem->count(0)), problem->angle(1, at / problem->count(0)));
      for (const double value : values.col(at)) fmt::format_to(out, FMT_COMPILE(",{}"), value);
      text.push_back('\n');
    }
  }
  return fmt::to_string(text);
}

}  // namespace arcslip
