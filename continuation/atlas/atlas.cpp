#include "arcslip/continuation/atlas/atlas.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>
#include <stdexcept>

#include "arcslip/continuation/atlas/fold_curves.hpp"
#include "arcslip/continuation/atlas/ridges.hpp"

namespace arcslip::continuation {
namespace {

using Clock = std::chrono::steady_clock;

std::array<AtlasSide, 2> sides_of(const Problem& problem, const AtlasOptions& options) {
  const std::vector<std::string> names = problem.parameter_names();
  std::array<AtlasSide, 2> sides;
  for (std::size_t k = 0; k < 2; ++k) {
    sides[k].parameter = index_of(names, options.parameters[k]);
    sides[k].low = std::min(options.from[k], options.to[k]);
    sides[k].high = std::max(options.from[k], options.to[k]);
    if (!(sides[k].low < sides[k].high) || !std::isfinite(sides[k].high - sides[k].low))
      throw std::invalid_argument(
          fmt::format("cover: the range of {} must be of two different numbers, got {:g} and {:g}",
                      options.parameters[k], options.from[k], options.to[k]));
  }
  if (sides[0].parameter == sides[1].parameter)
    throw std::invalid_argument("cover: both parameters are " + options.parameters[0]);
  return sides;
}

void check(const Problem& problem, const std::vector<Guess>& starts, const std::array<AtlasSide, 2>& sides,
           const AtlasOptions& options) {
  if (starts.empty()) throw std::invalid_argument("cover: at least one guess is needed");
  const std::vector<std::string> names = problem.parameter_names();
  for (const Guess& start : starts) {
    for (const AtlasSide& side : sides) {
      const double value = start.parameters(side.parameter);
      if (!(value >= side.low && value <= side.high))
        throw std::invalid_argument(
            fmt::format("cover: a start has {} = {:g}, which is not from {:g} to {:g}",
                        names[static_cast<std::size_t>(side.parameter)], value, side.low, side.high));
    }
  }
  const std::vector<Observable> observables = problem.observables();
  for (const std::string& name : options.extrema_of) {
    const Index which = index_of(observable_names(problem), name);
    if (!observables[static_cast<std::size_t>(which)].has_gradient)
      throw std::invalid_argument(fmt::format("cover: '{}' has no gradient", name));
  }
}

/// One look at the surface, with a scale of the unknowns.
struct Survey {
  Survey(const Problem& problem, const std::array<AtlasSide, 2>& sides, const std::vector<Guess>& starts,
         const Vector& scale, const AtlasOptions& options)
      : surface(problem, sides, starts.front(), scale), covering(surface, options) {}

  /// Covers what hangs together with a guess; false where it was ended before.
  bool spread(const Guess& start, std::size_t most) {
    Vector x = surface.place(start);
    Matrix fixed = Matrix::Zero(2, x.size());
    fixed.rightCols<2>().setIdentity();
    const Vector given = x;
    if (!surface.settle(x, fixed, given.tail<2>())) {  // as at a fold
      x = given;
      if (!surface.approach(x)) {
        if (lost.empty()) lost = "no solution was found next to a start";
        return true;
      }
    }
    return covering.spread(x, most);
  }

  Surface surface;
  Covering covering;
  std::string lost;  // why a start began nothing
};

/// How far unknowns go where parameters go through the box, by a look at parts of the surface through each
/// start, again until it fits.
Vector find_scale(const Problem& problem, const std::array<AtlasSide, 2>& sides,
                  const std::vector<Guess>& starts, const AtlasOptions& options, long& evaluations) {
  constexpr std::size_t some = 400;  // charts
  constexpr int most = 20;           // looks
  constexpr double fits = 2;
  constexpr double factor = 1e3;   // at once
  constexpr double digits = 1e-5;  // of the largest unknown: what is left of them is enough for a surface
  AtlasOptions coarse = options;
  coarse.max_radius = 0.2;
  coarse.max_turn = 0.5;
  const Guess& first = starts.front();
  Vector scale(problem.size());
  Vector of_parameters(first.parameters.size());
  problem.scale(first.unknowns, first.parameters, scale, of_parameters);
  for (int look = 0; look < most; ++look) {
    Vector ratio = Vector::Zero(scale.size());
    Vector largest = Vector::Zero(scale.size());
    bool is_seen = false;
    for (const Guess& start : starts) {
      Survey survey(problem, sides, {start}, scale, coarse);
      survey.spread(start, some);
      evaluations += survey.surface.evaluations();
      const std::vector<Disc>& discs = survey.covering.discs();
      if (discs.empty()) continue;  // where it bends at once the scale is too large
      is_seen = true;
      Vector low = discs.front().at;
      Vector high = low;
      for (const Disc& disc : discs) {
        low = low.cwiseMin(disc.at);
        high = high.cwiseMax(disc.at);
        const Vector size = survey.surface.solution(disc.at).unknowns.cwiseAbs().cwiseQuotient(scale);
        largest = largest.cwiseMax(size);
      }
      const double across = std::max((high - low).tail<2>().minCoeff(), 1e-12);
      ratio = ratio.cwiseMax((high - low).head(scale.size()) / across);
    }
    for (Index i = 0; i < ratio.size(); ++i) {
      if (largest(i) == 0 && ratio(i) == 0) ratio(i) = is_seen ? 1 : 0;
    }
    ratio = ratio.cwiseMax(digits * largest).cwiseMax(1 / factor).cwiseMin(factor);
    if (ratio.maxCoeff() < fits && ratio.minCoeff() > 1 / fits) break;
    scale = scale.cwiseProduct(ratio);
  }
  return scale;
}

void tell_components(const Triangulation& triangles, Atlas& atlas) {
  const std::vector<int> least = triangles.components();
  std::vector<int> number(least.size(), -1);
  for (std::size_t i = 0; i < least.size(); ++i) {
    int& name = number[static_cast<std::size_t>(least[i])];
    if (name < 0) {
      name = static_cast<int>(atlas.components.size());
      atlas.components.push_back({0, 0, 0, true});
    }
    atlas.charts[i].component = name;
    AtlasComponent& component = atlas.components[static_cast<std::size_t>(name)];
    ++component.charts;
    ++component.euler;
  }
  for (const Triangulation::Face& face : triangles.faces()) {
    AtlasComponent& component =
        atlas.components[static_cast<std::size_t>(atlas.charts[static_cast<std::size_t>(face[0])].component)];
    ++component.faces;
    ++component.euler;
    for (std::size_t i = 0; i < 3; ++i) {
      const int a = face[i];
      const int b = face[(i + 1) % 3];
      const bool is_inside = triangles.has(b, a);
      if (!is_inside || a < b) --component.euler;
      if (!is_inside) component.closed = false;
    }
  }
  for (AtlasComponent& component : atlas.components)
    component.closed = component.closed && component.faces > 0;
}

Chart told(const Problem& problem, Surface& surface, const Disc& disc) {
  constexpr double no_shadow = 1e-12;
  const Guess at = surface.solution(disc.at);
  Chart chart{at.unknowns, at.parameters, disc.radius};
  chart.sides = disc.sides;
  const double shadow = Surface::shadow(disc.plane);
  Matrix plane;
  if (std::abs(shadow) > no_shadow && surface.tangent(disc.at, disc.plane, plane))
    chart.determinant = (shadow > 0 ? 1 : -1) * surface.orientation(disc.plane);
  ComplexVector eigenvalues;
  if (problem.eigenvalues(at.unknowns, at.parameters, at.regime, eigenvalues))
    chart.unstable = static_cast<int>((eigenvalues.real().array() > 0).count());
  return chart;
}

/// Why a surface is not covered whole; empty where it is.
std::string why_open(const Survey& survey, const Triangulation& triangles, const AtlasOptions& options) {
  if (!survey.lost.empty()) return survey.lost;
  if (triangles.rims().empty() && (survey.covering.failure().empty() || !triangles.faces().empty()))
    return "";
  std::string why = survey.covering.failure();
  if (!triangles.rims().empty()) {
    const Disc& disc = survey.covering.discs()[static_cast<std::size_t>(triangles.rims().front())];
    const Guess at = survey.surface.solution(disc.at);
    const auto value = [&](std::size_t k) { return at.parameters(survey.surface.sides()[k].parameter); };
    why += fmt::format("{}the triangles have a rim inside the box, as at {} = {:.10g}, {} = {:.10g}",
                       why.empty() ? "" : "; ", options.parameters[0], value(0), options.parameters[1],
                       value(1));
  }
  return why;
}

}  // namespace

Atlas cover(const Problem& problem, const std::vector<Guess>& starts, const AtlasOptions& options) {
  const std::array<AtlasSide, 2> sides = sides_of(problem, options);
  check(problem, starts, sides, options);
  const Clock::time_point begun = Clock::now();
  AtlasOptions all = options;
  bool is_late = false;
  all.go_on = [&] {
    is_late = is_late || std::chrono::duration<double>(Clock::now() - begun).count() > options.max_seconds;
    return !is_late && (!options.go_on || options.go_on());
  };
  if (!(options.max_radius > 0 && options.max_radius <= 0.5))
    throw std::invalid_argument(
        fmt::format("cover: max_radius must be above 0 and at most 0.5, got {:g}", options.max_radius));
  Atlas atlas;
  atlas.scale = find_scale(problem, sides, starts, all, atlas.evaluations);
  Survey survey(problem, sides, starts, atlas.scale, all);
  const auto most = static_cast<std::size_t>(std::max(options.most_charts, 1L));
  std::optional<Stop> ended;
  for (const Guess& start : starts) {
    if (survey.spread(start, most)) continue;
    ended = survey.covering.discs().size() >= most ? Stop::max_points
            : is_late                              ? Stop::time_limit
                                                   : Stop::interrupted;
    break;
  }
  const Triangulation triangles(survey.covering.discs());
  for (const Disc& disc : survey.covering.discs())
    atlas.charts.push_back(told(problem, survey.surface, disc));
  atlas.faces = triangles.faces();
  tell_components(triangles, atlas);
  ZeroCurves zeros(problem, survey.surface, survey.covering, triangles);
  atlas.folds = fold_curves(problem, survey.surface, survey.covering.discs(), zeros);
  const bool has_all_folds = !zeros.has_failed();
  atlas.ridges = ridges(problem, survey.surface, survey.covering.discs(), zeros, options.extrema_of);
  atlas.reason =
      ended == Stop::max_points
          ? fmt::format("the most charts that were allowed, {}, are not enough", options.most_charts)
      : ended == Stop::time_limit ? "the time is up"
      : ended                     ? "it was interrupted"
                                  : why_open(survey, triangles, options);
  if (atlas.reason.empty() && zeros.has_failed())
    atlas.reason =
        fmt::format("{} could not be located on its edge", has_all_folds ? "an extremum" : "a fold");
  atlas.stop = atlas.reason.empty() ? Stop::reached_end : ended.value_or(Stop::min_step);
  atlas.evaluations += survey.surface.evaluations();
  return atlas;
}

}  // namespace arcslip::continuation
