#include "results/atlas_table.hpp"

#include <fmt/compile.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>
#include <map>

#include "results/branch_columns.hpp"

namespace arcslip {
namespace {

using continuation::AtlasFold;
using continuation::Chart;
using continuation::PointType;
using nlohmann::ordered_json;

bool tells_unstable(const TracedBranch& traced) {
  const std::vector<Chart>& charts = traced.surface->charts;
  return !charts.empty() && charts.front().unstable >= 0;
}

/// Names with commas before each.
std::string listed(const std::vector<std::string>& names) {
  return names.empty() ? "" : fmt::format(",{}", fmt::join(names, ","));
}

/// Parameters and observables of solutions.
class Values {
 public:
  explicit Values(const TracedBranch& traced) : columns_(traced), physical_(traced) {}

  std::string names() const { return listed(columns_.names()); }
  std::string physical_names() const { return listed(physical_.names()); }

  template <class Solution>
  const std::vector<double>& operator()(const Solution& one) {
    point_.unknowns = one.unknowns;
    point_.parameters = one.parameters;
    return columns_.values(point_);
  }

  std::vector<double> physical(const std::vector<double>& row) const { return physical_.values(row); }

 private:
  Columns columns_;
  PhysicalColumns physical_;
  continuation::BranchPoint point_;
};

void append(fmt::memory_buffer& text, const std::vector<double>& values) {
  for (const double value : values) fmt::format_to(std::back_inserter(text), FMT_COMPILE(",{}"), value);
}

}  // namespace

std::string atlas_header(const TracedBranch& traced) {
  const Values values(traced);
  return "branch,chart,component" + values.names() + ",determinant" +
         (tells_unstable(traced) ? ",unstable" : "") + ",radius" + values.physical_names() + "\n";
}

std::string atlas_rows(std::size_t number, const TracedBranch& traced) {
  fmt::memory_buffer text;
  if (!traced.surface) return "";
  Values values(traced);
  const auto out = std::back_inserter(text);
  for (std::size_t i = 0; i < traced.surface->charts.size(); ++i) {
    const Chart& chart = traced.surface->charts[i];
    fmt::format_to(out, FMT_COMPILE("{},{},{}"), number, i, chart.component);
    const std::vector<double>& row = values(chart);
    append(text, row);
    fmt::format_to(out, FMT_COMPILE(",{}"), chart.determinant);
    if (tells_unstable(traced)) fmt::format_to(out, FMT_COMPILE(",{}"), chart.unstable);
    append(text, {chart.radius});
    append(text, values.physical(row));
    text.push_back('\n');
  }
  return fmt::to_string(text);
}

std::string faces_header(const TracedBranch& /*traced*/) { return "branch,face,chart_1,chart_2,chart_3\n"; }

std::string face_rows(std::size_t number, const TracedBranch& traced) {
  fmt::memory_buffer text;
  if (!traced.surface) return "";
  for (std::size_t i = 0; i < traced.surface->faces.size(); ++i)
    fmt::format_to(std::back_inserter(text), FMT_COMPILE("{},{},{}\n"), number, i,
                   fmt::join(traced.surface->faces[i], ","));
  return fmt::to_string(text);
}

std::string folds_header(const TracedBranch& traced) {
  const Values values(traced);
  return "branch,fold_curve,point,type" + values.names() + values.physical_names() + "\n";
}

std::string fold_rows(std::size_t number, const TracedBranch& traced) {
  fmt::memory_buffer text;
  if (!traced.surface) return "";
  Values values(traced);
  std::size_t point = 0;
  const std::vector<AtlasFold>& folds = traced.surface->folds;
  for (std::size_t i = 0; i < folds.size(); ++i) {
    point = i > 0 && folds[i].curve == folds[i - 1].curve ? point + 1 : 0;
    fmt::format_to(std::back_inserter(text), FMT_COMPILE("{},{},{},{}"), number, folds[i].curve, point,
                   to_string(folds[i].type));
    const std::vector<double>& row = values(folds[i]);
    append(text, row);
    append(text, values.physical(row));
    text.push_back('\n');
  }
  return fmt::to_string(text);
}

ordered_json surface_to_json(const continuation::Atlas& surface) {
  const auto count = [&](PointType type) {
    return std::count_if(surface.folds.begin(), surface.folds.end(),
                         [&](const AtlasFold& fold) { return fold.type == type; });
  };
  ordered_json components = ordered_json::array();
  for (const continuation::AtlasComponent& one : surface.components)
    components.push_back(
        {{"charts", one.charts}, {"faces", one.faces}, {"euler", one.euler}, {"closed", one.closed}});
  return {{"charts", surface.charts.size()},
          {"faces", surface.faces.size()},
          {"components", components},
          {"fold_curves", surface.folds.empty() ? 0 : surface.folds.back().curve + 1},
          {"cusps", count(PointType::cusp)},
          {"complete", surface.complete()}};
}

std::string surface_sentence(const ordered_json& told) {
  const auto of = [](std::size_t number, const char* what) {
    return fmt::format("{} {}{}", number, what, number == 1 ? "" : "s");
  };
  const auto number = [&](const char* name) { return told.at(name).get<std::size_t>(); };
  return fmt::format("The surface has {} in {}, {} and {}; it is {}.", of(number("charts"), "chart"),
                     of(told.at("components").size(), "component"), of(number("fold_curves"), "fold curve"),
                     of(number("cusps"), "cusp"),
                     told.at("complete").get<bool>() ? "complete" : "not complete");
}

}  // namespace arcslip
