// Where a curve of extrema leaves a place along a border.

#include "arcslip/continuation/curves/extremum_tracer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace arcslip::continuation {

/// The point and one a little way along the border; empty where the border does not go on in the regime.
std::vector<BranchPoint> ExtremumTracer::step_off(BorderProblem& edge, const BasePoint& from, bool up,
                                                  double way) const {
  if (!edge.adapt(from)) return {};
  const TraceOptions free = freely(way);
  Branch step = trace_one_way(edge, guess_at(from), up, free);
  const bool goes = step.points.size() == 2 && step.points.back().arclength > 0.01 * way;
  if (!goes) return {};
  BranchPoint& beside = step.points.back();
  beside.unknowns = guess_at(settled(edge, split(beside))).unknowns;
  return std::move(step.points);
}

/// Of a slope that vanishes but for what is left of it: larger ones are surely no rounding.
double ExtremumTracer::rounding_of(double left) const {
  return options_.tolerances.no_slope + 10 * std::abs(left);
}

/// So far that a slope which vanishes at the place is no rounding.
std::vector<BranchPoint> ExtremumTracer::surely_off(BorderProblem& edge, const BasePoint& from, bool up,
                                                    const std::optional<Regime>& vanishing) {
  const Side side =
      vanishing == slopes_.regime(CornerSlopes::leaving) ? CornerSlopes::leaving : CornerSlopes::arriving;
  const double level =
      vanishing ? options_.tolerances.plain_slope + rounding_of(slopes_.slope(from, side)) : 0;
  std::vector<BranchPoint> step;
  for (double way = shortest_way; way <= longest_way; way *= 10) {
    step = step_off(edge, from, up, way);
    if (!step.empty() && std::abs(slopes_.slope(split(step.back()), side)) > level) break;
  }
  return step;
}

/// A slope inside that is no rounding, next to a place on the border where it vanishes. What turns nearer
/// than the shortest way is not told apart from the place.
ExtremumTracer::Inside ExtremumTracer::next_inside(const BasePoint& corner, Side side) {
  const double level = rounding_of(slopes_.slope(corner, side));
  double slope = slopes_.slope_inside(corner, side, shortest_way);
  double way = shortest_way;
  while (!(std::abs(slope) > level) && way < longest_way)
    slope = slopes_.slope_inside(corner, side, way *= 10);
  return {slope, way};
}

/// The pieces that leave a point along a border of its regime.
void ExtremumTracer::add_ledges(const BasePoint& at, int border, const Place& place,
                                std::vector<Ledge>& all) {
  if (!slopes_.begin(at, border) || slopes_.touch(at, options_.tolerances.touches)) return;
  BorderProblem edge(base_, problem_.active(), border);
  for (const bool up : {true, false}) {
    const std::vector<BranchPoint> step = surely_off(edge, at, up, place.vanishing);
    if (step.empty()) continue;
    const BranchPoint& from = step.front();
    constexpr double back = -0.999999;  // the cosine of the way that the curve came
    if (place.peak && steps(from.tangent, from).dot(steps(place.arrival, from)) < back) continue;
    const BasePoint beside = split(step.back());
    const auto other = nearest_border(base_, problem_.active(), beside, at.regime, border);
    if (other && other->distance < 0) continue;
    const double before = slopes_.slope(beside, CornerSlopes::arriving);
    const double behind = slopes_.slope(beside, CornerSlopes::leaving);
    if (before * behind < 0) all.push_back({at, border, from.tangent, beside, before > 0});
  }
}

/// Those that leave a place in all regimes that meet there.
std::vector<ExtremumLedge> ExtremumTracer::ledges(const Place& place) {
  constexpr std::size_t most = 16;  // regimes
  std::vector<Ledge> all;
  std::vector<Regime> regimes{place.at.regime};
  for (std::size_t i = 0; i < regimes.size() && regimes.size() < most; ++i) {
    BasePoint at = place.at;
    at.regime = regimes[i];
    for (int b = 0; b < base_.border_count(at.regime); ++b) {
      const double value = base_.border(at.unknowns, at.parameters, at.regime, b, nullptr);
      const auto beyond = base_.regime_beyond(at.regime, b);
      if (!(std::abs(value) <= options_.tolerances.together) || !beyond) continue;
      const auto known = std::find(regimes.begin(), regimes.end(), *beyond);
      const bool was_seen_from_there = known < regimes.begin() + static_cast<std::ptrdiff_t>(i);
      if (!was_seen_from_there) add_ledges(at, b, place, all);
      if (known == regimes.end()) regimes.push_back(*beyond);
    }
  }
  return all;
}

/// The side beyond a border on both sides of which the response has one slope where the curve comes to it:
/// there nothing but the regime changes. It may go with the root of the way from there, and be far from zero
/// where points are known to rounding, but less so than a little farther away.
std::optional<CornerSlopes::Side> ExtremumTracer::smooth_side(const Place& place) {
  constexpr double beside = 1e-5;  // in the scale
  constexpr double rises = 0.2;    // of the slope there
  const Regime& regime = place.at.regime;
  for (int b = 0; b < base_.border_count(regime); ++b) {
    const double value = base_.border(place.at.unknowns, place.at.parameters, regime, b, nullptr);
    if (!(std::abs(value) <= options_.tolerances.together) || !slopes_.begin(place.at, b)) continue;
    const auto vanishes = [&](CornerSlopes::Side side) {
      const double here = std::abs(slopes_.slope(place.at, side));
      return here <= options_.tolerances.same_slope ||
             here <= rises * std::abs(slopes_.slope_inside(place.at, side, beside));
    };
    if (!vanishes(CornerSlopes::arriving) || !vanishes(CornerSlopes::leaving)) continue;
    border_ = b;
    return slopes_.regime(CornerSlopes::leaving) == regime ? CornerSlopes::arriving : CornerSlopes::leaving;
  }
  return std::nullopt;
}

/// Goes on along a border: as a peak where it came as one, straight on if there are several.
bool ExtremumTracer::leave(const Place& place) {
  if (is_satisfied()) return false;
  const std::vector<Ledge> all = ledges(place);
  const BranchPoint& here = curve_.points.back();
  const auto rank = [&](const Ledge& ledge) {
    const double straight = steps(ledge.direction, here).dot(steps(place.arrival, here));
    return (place.peak == ledge.peak ? 2 : 0) + straight;
  };
  const auto best = std::max_element(all.begin(), all.end(),
                                     [&](const Ledge& a, const Ledge& b) { return rank(a) < rank(b); });
  if (best == all.end()) {
    if (const auto side = smooth_side(place)) return enter(*side);
  }
  if (best == all.end()) {
    stop(
        Stop::grazing_border,
        fmt::format("the extremum comes to a border and no corner goes on from there, at {}", this->place()));
    return false;
  }
  curve_.points.back().regime = best->from.regime;
  along(*best, place.vanishing);
  return true;
}

}  // namespace arcslip::continuation
