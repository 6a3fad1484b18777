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
  const std::vector<std::string>& all_names() const { return columns_.names(); }
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

namespace {

/// The name of the parameter that turns, or nothing.
std::string turning(const TracedBranch& traced, const AtlasFold& fold) {
  return fold.turns < 0    ? ""
         : fold.turns == 0 ? traced.request->curve->active
                           : traced.request->options.parameter;
}

/// Rows of points on curves, with what `further` tells of each behind its type.
template <class Points, class Further>
std::string curve_rows(std::size_t number, const TracedBranch& traced, const Points& points,
                       const Further& further) {
  fmt::memory_buffer text;
  Values values(traced);
  std::size_t point = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    point = i > 0 && points[i].curve == points[i - 1].curve ? point + 1 : 0;
    fmt::format_to(std::back_inserter(text), FMT_COMPILE("{},{},{},{},{}"), number, points[i].curve, point,
                   to_string(points[i].type), further(points[i]));
    const std::vector<double>& row = values(points[i]);
    append(text, row);
    append(text, values.physical(row));
    text.push_back('\n');
  }
  return fmt::to_string(text);
}

/// Cusps and where isolas are born or merge.
ordered_json special_folds(const TracedBranch& traced) {
  Values values(traced);
  ordered_json listed = ordered_json::array();
  for (const AtlasFold& fold : traced.surface->folds) {
    if (fold.type != PointType::cusp && fold.turns < 0) continue;
    ordered_json& told = listed.emplace_back();
    told["type"] = to_string(fold.type);
    if (fold.turns >= 0) told["turns"] = turning(traced, fold);
    const std::vector<double>& row = values(fold);
    for (std::size_t i = 0; i < row.size(); ++i) told[values.all_names()[i]] = row[i];
  }
  return listed;
}

}  // namespace

std::string folds_header(const TracedBranch& traced) {
  const Values values(traced);
  return "branch,fold_curve,point,type,turns" + values.names() + values.physical_names() + "\n";
}

std::string fold_rows(std::size_t number, const TracedBranch& traced) {
  if (!traced.surface) return "";
  return curve_rows(number, traced, traced.surface->folds,
                    [&](const AtlasFold& fold) { return turning(traced, fold); });
}

std::string ridges_header(const TracedBranch& traced) {
  const Values values(traced);
  return "branch,ridge,point,type,observable" + values.names() + values.physical_names() + "\n";
}

std::string ridge_rows(std::size_t number, const TracedBranch& traced) {
  if (!traced.surface) return "";
  return curve_rows(number, traced, traced.surface->ridges,
                    [](const continuation::AtlasRidge& ridge) { return ridge.observable; });
}

ordered_json surface_to_json(const TracedBranch& traced) {
  const continuation::Atlas& surface = *traced.surface;
  const auto count = [&](PointType type) {
    return std::count_if(surface.folds.begin(), surface.folds.end(),
                         [&](const AtlasFold& fold) { return fold.type == type; });
  };
  const auto curves = [](const auto& points) { return points.empty() ? 0 : points.back().curve + 1; };
  ordered_json components = ordered_json::array();
  for (const continuation::AtlasComponent& one : surface.components)
    components.push_back(
        {{"charts", one.charts}, {"faces", one.faces}, {"euler", one.euler}, {"closed", one.closed}});
  return {{"charts", surface.charts.size()},
          {"faces", surface.faces.size()},
          {"components", components},
          {"fold_curves", curves(surface.folds)},
          {"cusps", count(PointType::cusp)},
          {"isola_centres", count(PointType::isola_centre)},
          {"simple_bifurcations", count(PointType::simple_bifurcation)},
          {"special", special_folds(traced)},
          {"ridges", curves(surface.ridges)},
          {"complete", surface.complete()}};
}

std::string surface_sentence(const ordered_json& told) {
  const auto of = [](std::size_t number, const char* what) {
    return fmt::format("{} {}{}", number, what, number == 1 ? "" : "s");
  };
  const auto number = [&](const char* name) { return told.at(name).get<std::size_t>(); };
  std::vector<std::string> parts{of(number("fold_curves"), "fold curve")};
  for (const auto& [name, what] :
       {std::pair{"cusps", "cusp"}, std::pair{"isola_centres", "isola centre"},
        std::pair{"simple_bifurcations", "simple bifurcation"}, std::pair{"ridges", "ridge"}}) {
    if (number(name) > 0) parts.push_back(of(number(name), what));
  }
  const std::string last = parts.back();
  parts.pop_back();
  return fmt::format("The surface has {} in {}{}{} and {}; it is {}.", of(number("charts"), "chart"),
                     of(told.at("components").size(), "component"), parts.empty() ? "" : ", ",
                     fmt::join(parts, ", "), last,
                     told.at("complete").get<bool>() ? "complete" : "not complete");
}

}  // namespace arcslip
