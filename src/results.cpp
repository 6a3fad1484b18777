#include "arcslip/results.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

namespace arcslip {
namespace {

using continuation::BranchPoint;
using continuation::PointType;
using nlohmann::ordered_json;

std::vector<std::string> observable_names(const continuation::Problem& problem) {
  std::vector<std::string> names;
  for (const continuation::Observable& observable : problem.observables()) names.push_back(observable.name);
  return names;
}

ordered_json to_json(const SpecialPoint& special) {
  return {{"type", to_string(special.type)},
          {"eta", special.eta},
          {"P", special.preload},
          {"R_over_S", special.R_over_S},
          {"Y", special.Y}};
}

ordered_json highest_peak(const std::vector<SpecialPoint>& special) {
  const SpecialPoint* best = nullptr;
  for (const SpecialPoint& point : special) {
    if (point.type == PointType::peak && (best == nullptr || point.Y > best->Y)) best = &point;
  }
  if (best == nullptr) return nullptr;
  return {{"eta", best->eta}, {"Y", best->Y}, {"R_over_S", best->R_over_S}};
}

ordered_json summarize(std::size_t number, const TracedBranch& traced) {
  const std::vector<SpecialPoint> special = special_points(traced);
  ordered_json listed = ordered_json::array();
  for (const SpecialPoint& point : special) listed.push_back(to_json(point));
  const continuation::Work& work = traced.branch.work;
  return {{"branch", number},
          {"values", traced.request->values},
          {"points", traced.branch.points.size()},
          {"stop", to_string(traced.branch.stop)},
          {"explanation", traced.branch.explanation},
          {"special", listed},
          {"peak", highest_peak(special)},
          {"work",
           {{"evaluations", work.evaluations},
            {"factorizations", work.factorizations},
            {"iterations", work.iterations},
            {"rejected_steps", work.rejected_steps}}},
          {"seconds", traced.seconds}};
}

}  // namespace

std::vector<SpecialPoint> special_points(const TracedBranch& traced) {
  const std::vector<std::string> parameters = traced.problem->parameter_names();
  const std::vector<std::string> observables = observable_names(*traced.problem);
  const Index eta = continuation::index_of(parameters, "eta");
  const Index preload = continuation::index_of(parameters, "P");
  const Index ratio = continuation::index_of(observables, "R_over_S");
  const Index amplitude = continuation::index_of(observables, "Y");
  std::vector<SpecialPoint> special;
  Vector values;
  for (std::size_t i = 0; i < traced.branch.points.size(); ++i) {
    const BranchPoint& point = traced.branch.points[i];
    if (point.type == PointType::regular) continue;
    traced.problem->observe(point.unknowns, point.parameters, point.regime, values);
    special.push_back(
        {i, point.type, point.parameters(eta), point.parameters(preload), values(ratio), values(amplitude)});
  }
  return special;
}

void write_branches(const std::vector<TracedBranch>& traced, const Sink& sink) {
  fmt::memory_buffer row;
  const auto out = std::back_inserter(row);
  const auto flush = [&] {
    sink({row.data(), row.size()});
    row.clear();
  };
  const continuation::Problem& first = *traced.front().problem;
  fmt::format_to(out, "branch,point,type,regime");
  for (const std::string& name : first.parameter_names()) fmt::format_to(out, ",{}", name);
  for (const std::string& name : observable_names(first)) fmt::format_to(out, ",{}", name);
  fmt::format_to(out, ",arclength,iterations,residual\n");
  flush();
  Vector values;
  for (std::size_t number = 0; number < traced.size(); ++number) {
    const TracedBranch& one = traced[number];
    const std::vector<std::string> regimes = one.problem->regime_names();
    for (std::size_t i = 0; i < one.branch.points.size(); ++i) {
      const BranchPoint& point = one.branch.points[i];
      one.problem->observe(point.unknowns, point.parameters, point.regime, values);
      fmt::format_to(out, "{},{},{},{}", number, i, to_string(point.type),
                     regimes[static_cast<std::size_t>(point.regime)]);
      for (const double value : point.parameters) fmt::format_to(out, ",{:.17g}", value);
      for (const double value : values) fmt::format_to(out, ",{:.17g}", value);
      fmt::format_to(out, ",{:.17g},{},{:.17g}\n", point.arclength, point.iterations, point.residual);
      flush();
    }
  }
}

ordered_json summarize(const Case& input, const std::vector<TracedBranch>& traced, double seconds) {
  ordered_json branches = ordered_json::array();
  for (std::size_t number = 0; number < traced.size(); ++number)
    branches.push_back(summarize(number, traced[number]));
  return {{"arcslip", ARCSLIP_VERSION},
          {"title", input.title},
          {"case", input.resolved},
          {"branches", branches},
          {"seconds", seconds}};
}

std::string special_table_header() {
  return fmt::format("{:>6} {:>6}  {:<8} {:>14} {:>13} {:>13} {:>14}\n", "branch", "point", "type", "eta",
                     "P", "R/S", "Y");
}

std::string special_table(std::size_t number, const TracedBranch& traced) {
  std::string rows;
  for (const SpecialPoint& special : special_points(traced)) {
    rows += fmt::format("{:>6} {:>6}  {:<8} {:>14.9g} {:>13.8g} {:>13.7g} {:>14.8e}\n", number, special.point,
                        to_string(special.type), special.eta, special.preload, special.R_over_S, special.Y);
  }
  return rows;
}

}  // namespace arcslip
