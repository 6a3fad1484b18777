// Where a curve of extrema comes to a border, and where it leaves one into a regime.

#include "arcslip/continuation/curves/extremum_tracer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "arcslip/continuation/path/newton.hpp"
#include "arcslip/continuation/points/normal_form.hpp"
#include "arcslip/zero_between.hpp"

namespace arcslip::continuation {

/// Rows on the values asked for that lie between two values of the parameter, beside a corner at one of them.
/// False where the curve ends on one of them.
bool ExtremumTracer::fill(int border, const BasePoint& corner, double from, double to, Side side) {
  std::vector<double> targets = options_.stop_at;
  targets.push_back(options_.from);
  targets.push_back(options_.to);
  std::erase_if(targets, [&](double t) { return !((t - from) * (to - t) > 0); });
  std::sort(targets.begin(), targets.end(),
            [&](double a, double b) { return std::abs(a - from) < std::abs(b - from); });
  BorderProblem edge(base_, problem_.active(), border);
  for (const double target : targets) {
    Guess guess = guess_at(corner);
    guess.parameters(parameter_) = target;
    const auto at =
        locate(edge, problem_.split(guess.unknowns, guess.parameters, corner.regime), options_.tolerance);
    const auto found = at ? slopes_.extremum_inside(at->point, side) : std::nullopt;
    if (!found) continue;
    BranchPoint point = row(*found, PointType::user);
    point.tangent = direction_to(point);
    const bool ends = target == options_.from || target == options_.to;
    if (ends) point.type = PointType::end;
    add(std::move(point));
    if (ends) return finish(target);
  }
  return !told_to_end_;
}

/// Goes on from the corner that is the last row, where the slope on one side vanishes, as a smooth extremum.
bool ExtremumTracer::enter(Side side) {
  BranchPoint& here = curve_.points.back();
  here.type = PointType::regime_switch;
  here.label.clear();
  here.regime = slopes_.regime(side);
  here.arrival = here.tangent;
  if (is_satisfied()) return false;
  BasePoint met = split(here);
  met.regime = slopes_.regime(CornerSlopes::arriving);
  if (slopes_.touch(met, options_.tolerances.touches)) return pass(met, side);
  const BasePoint corner = refined(met, border_, side);
  const auto [inside, from] = next_inside(corner, side);
  const auto outer = slopes_.extremum_inside(corner, side, from);
  const bool turns = outer && distance(*outer) < narrow;
  const auto next =
      turns ? first_inside(corner, side, -inside, distance(*outer)) : first_inside(corner, side, inside, 0);
  if (!next) return pass(met, side);
  const Guess moved = guess_at(corner);
  here.unknowns = moved.unknowns;
  here.parameters = moved.parameters;
  Vector direction = way(here, row(*next, PointType::regular));
  if (turns) {
    const auto fold = fold_beside(corner, border_, side);
    if (fold && fold->parameters != corner.parameters) direction = way(here, row(*fold, PointType::fold));
  }
  direction /= steps(direction, here).norm();
  here.tangent = direction;
  turn(direction, slopes_.regime(side));
  if (turns) {
    if (!add_fold(corner, border_, side)) {
      stop(Stop::grazing_border, fmt::format("the extremum turns beside a border, at {}", place()));
      return false;
    }
  } else if (told_to_end_ || !fill(border_, corner, value(corner), value(*next), side)) {
    return false;
  }
  passes_ = true;
  smooth(guess_at(*next, direction), true, 0);
  return true;
}

bool ExtremumTracer::ends_at_border() {
  stop(Stop::grazing_border,
       fmt::format("the extremum leaves a border and no smooth one goes on from there, at {}", place()));
  return false;
}

/// Goes on from a corner where the response touches the border, or all but does, as it does where the
/// observable is what the border is told by: the extremum comes to the border from the middle of one side and
/// goes on in the middle of the other, and no point of the border beside it leads there.
bool ExtremumTracer::pass(const BasePoint& corner, Side side) {
  BranchPoint& here = curve_.points.back();
  const auto next = straight_on(corner, side);
  if (!next) return ends_at_border();
  const bool up = here.arrival(here.arrival.size() - 1) > 0;
  const Branch ahead = trace_one_way(problem_, guess_at(*next), up, freely(shortest_way));
  if (ahead.points.empty()) return ends_at_border();
  const Vector direction = ahead.points.front().tangent;
  here.tangent = direction;
  turn(direction, slopes_.regime(side));
  if (told_to_end_) return false;
  passes_ = true;
  smooth(guess_at(*next, direction), true, 0);
  return true;
}

/// The extremum in the regime of a side a little farther in the parameter than a corner.
std::optional<BasePoint> ExtremumTracer::straight_on(const BasePoint& corner, Side side) {
  const BranchPoint& here = curve_.points.back();
  const double arrival = here.arrival(here.arrival.size() - 1);
  BasePoint beyond = corner;
  beyond.regime = slopes_.regime(side);
  for (double way = shortest_way; way <= longest_way; way *= 10) {
    if (!problem_.adapt(beyond)) return std::nullopt;
    Guess guess = guess_at(beyond);
    guess.parameters(parameter_) += std::copysign(way * parameter_scale(here), arrival);
    const Solution found = solve(problem_, guess);
    if (found.outcome != Correction::converged) continue;
    const BasePoint next = problem_.split(found.unknowns, guess.parameters, guess.regime);
    const double inside = distance(next);
    if (inside > 0 && inside < narrow + way) return next;
  }
  return std::nullopt;
}

/// An extremum inside the regime of a side, beside a corner: of those along the border where the slope on it
/// has another sign than `inside` the farthest to which they lead. At the corner their distance is `least`.
std::optional<BasePoint> ExtremumTracer::first_inside(const BasePoint& corner, Side side, double inside,
                                                      double least) {
  BorderProblem edge(base_, problem_.active(), border_);
  struct Found {
    BasePoint point;
    double way;  // along the border, which may be shorter than asked for
  };
  const auto beside = [&](bool up, double way) -> std::optional<Found> {
    const std::vector<BranchPoint> step = step_off(edge, corner, up, way);
    if (step.empty() || !(slopes_.slope(split(step.back()), side) * inside < 0)) return std::nullopt;
    const auto found = slopes_.extremum_inside(split(step.back()), side);
    return found ? std::optional(Found{*found, step.back().arclength}) : std::nullopt;
  };
  std::optional<Found> last;
  for (const bool up : {true, false}) {
    for (double way = 10 * shortest_way; way <= 1.1 * longest_way; way *= 4) {
      const auto next = beside(up, way);
      // They come to the border as the way does, or as its square: all that is farther is another extremum.
      const auto leads = [&](const Found& from, const Found& to) {
        const double growth = to.way / from.way;
        const double most = 2 * growth * growth * std::abs(distance(from.point) - least);
        return distance(to.point) - least < std::max(most, shortest_way);
      };
      if (last && (!next || !leads(*last, *next))) break;
      if (next && (last || distance(next->point) < narrow)) last = next;
    }
    if (last) return last->point;
  }
  return std::nullopt;
}

/// A point on a border to rounding, as far as Newton's method comes.
BasePoint ExtremumTracer::settled(BorderProblem& edge, const BasePoint& point) {
  for (double rounding = 1e-15; rounding < 1e-11; rounding *= 10)
    if (const auto located = locate(edge, point, rounding)) return located->point;
  return point;
}

BasePoint ExtremumTracer::settled(const BasePoint& point, int border) const {
  BorderProblem edge(base_, problem_.active(), border);
  return settled(edge, point);
}

/// The point on a border at a value of the parameter, next to another one.
BasePoint ExtremumTracer::at_value(const BasePoint& next, int border, double value) const {
  Guess guess = guess_at(next);
  guess.parameters(parameter_) = value;
  return settled(problem_.split(guess.unknowns, guess.parameters, next.regime), border);
}

/// A place on a border where the slope on a side vanishes, to rounding: the tracer's points are good to its
/// tolerance, and of a sharp response the slope there is not.
BasePoint ExtremumTracer::refined(const BasePoint& point, int border, Side side) {
  constexpr double farthest = 1e-5;
  const double place = value(point);
  const double scale = parameter_scale(row(point, PointType::regular));
  const auto slope_at = [&](double at) { return slopes_.slope(at_value(point, border, at), side); };
  for (double reach = shortest_way; reach <= farthest; reach *= 10) {
    const double low = place - reach * scale;
    const double high = place + reach * scale;
    const double at_low = slope_at(low);
    const double at_high = slope_at(high);
    if (!(at_low * at_high < 0)) continue;
    return at_value(point, border, zero_between(slope_at, low, high, at_low, at_high));
  }
  return settled(point, border);
}

/// From a border.
double ExtremumTracer::distance(const BasePoint& point) const {
  const auto nearest = nearest_border(base_, problem_.active(), point, point.regime);
  return nearest ? nearest->distance : std::numeric_limits<double>::infinity();
}

/// Where the curve that leaves a corner into the regime of a side turns in its parameter, close to the
/// border: the slope inside, which has another sign at the border and further on, just touches zero. It is
/// the corner itself if that is nearer than the shortest way.
std::optional<BasePoint> ExtremumTracer::fold_beside(const BasePoint& corner, int border, Side side) {
  const double inside = next_inside(corner, side).slope;
  std::optional<BasePoint> top;
  const double scale = parameter_scale(row(corner, PointType::regular));
  const auto height = [&](double along, bool up) {
    const BasePoint from = at_value(corner, border, value(corner) + (up ? along : -along) * scale);
    if (!(slopes_.slope(from, side) * inside < 0)) return std::nan("");
    const auto highest = slopes_.steepest_inside(from, side, inside, narrow);
    if (highest) top = highest->point;
    return highest ? highest->slope : std::nan("");
  };
  for (const bool up : {true, false}) {
    double before = shortest_way;
    double at_before = height(before, up);
    if (at_before <= 0) return corner;
    for (double along = 2 * before; at_before > 0 && along < longest_way; along *= 2) {
      const double here = height(along, up);
      if (here <= 0) {
        height(zero_between([&](double x) { return height(x, up); }, before, along, at_before, here), up);
        return top;
      }
      before = along;
      at_before = here;
    }
  }
  return std::nullopt;
}

/// Rows of where the curve turns close to a border, coming from the last row.
bool ExtremumTracer::add_fold(const BasePoint& corner, int border, Side side) {
  const auto found = fold_beside(corner, border, side);
  if (!found) return false;
  if (found->parameters == corner.parameters) return true;
  BranchPoint fold = row(*found, PointType::fold);
  fold.tangent = direction_to(fold);
  fold.tangent(fold.tangent.size() - 1) = 0;
  add_turn(std::move(fold));
  return !told_to_end_;
}

/// Where a piece within a regime comes to a border, as the last row.
std::optional<ExtremumPlace> ExtremumTracer::meeting() {
  BranchPoint& last = curve_.points.back();
  const BasePoint at = split(last);
  const auto nearest = nearest_border(base_, problem_.active(), at, at.regime);
  if (!nearest || !(std::abs(nearest->distance) < within_reach)) return std::nullopt;
  if (!base_.regime_beyond(at.regime, nearest->border)) return std::nullopt;
  if (curve_.stop != Stop::left_regime) return meeting_beside(last, *nearest);
  last.type = PointType::regime_switch;
  last.arrival = last.tangent;
  return Place{at, at.regime, last.tangent, {}};
}

/// Whether the curve turns in its parameter between a point beside a border and the place on it where the
/// slope vanishes: then the extremum that leaves this place is another one. It leaves on the side on which
/// the slope on the border has another sign than inside, and is the first one inside.
bool ExtremumTracer::turns_between(const BasePoint& point, const NearestBorder& nearest,
                                   const BasePoint& beside, const BasePoint& place) {
  constexpr double same = 0.01;  // of the distance
  const double on_edge = slopes_.slope(beside, CornerSlopes::arriving);
  const auto first = slopes_.extremum_inside(beside, CornerSlopes::arriving);
  if (!slopes_.begin(place, nearest.border) || !first ||
      on_edge * next_inside(place, CornerSlopes::arriving).slope > 0)
    return true;
  const auto there = nearest_border(base_, problem_.active(), *first, point.regime);
  return !(std::abs(there->distance / nearest.distance - 1) < same);
}

/// Where the slope vanishes on the border beside the last row.
std::optional<ExtremumPlace> ExtremumTracer::meeting_beside(const BranchPoint& last,
                                                            const NearestBorder& nearest) {
  const Index active = problem_.active();
  const BasePoint from = split(last);
  Gradient gradient{Vector::Zero(problem_.size()), Vector::Zero(last.parameters.size())};
  const double border =
      problem_.border(last.unknowns, last.parameters, last.regime, nearest.border, &gradient);
  // A curve that touches the border comes to it twice as far on as one that crosses it.
  constexpr double sure = 10;
  const double most = std::clamp(sure * std::abs(border / rate(gradient, parameter_, last.tangent)),
                                 shortest_way, std::sqrt(within_reach));
  if (!std::isfinite(most)) return std::nullopt;
  BorderProblem edge(base_, active, nearest.border);
  const auto beside = locate(edge, from, options_.tolerance);
  if (!beside || !slopes_.begin(beside->point, nearest.border)) return std::nullopt;
  TraceOptions options = freely(most);
  options.max_points = 1000;
  options.events.push_back({before_vanishes, [&](const Vector& u, const Vector& p, const Regime& regime) {
                              return slopes_.slope(edge.split(u, p, regime), CornerSlopes::arriving);
                            }});
  options.stop_after.push_back({PointType::event, 1, before_vanishes});
  std::optional<BranchPoint> found;
  for (const bool up : {true, false}) {
    if (!edge.adapt(beside->point)) return std::nullopt;
    Branch way = trace_one_way(edge, guess_at(beside->point), up, options,
                               [&](const BranchPoint& point) { return point.arclength <= most; });
    if (way.points.empty() || way.points.back().type != PointType::event) continue;
    if (!found || way.points.back().arclength < found->arclength) found = way.points.back();
  }
  if (!found) return std::nullopt;
  const BasePoint at = refined(split(*found), nearest.border, CornerSlopes::arriving);
  const bool turns = turns_between(from, nearest, beside->point, at);
  if (turns && !add_fold(at, nearest.border, CornerSlopes::arriving)) return std::nullopt;
  if (!turns && !fill(nearest.border, at, value(from), value(at), CornerSlopes::arriving))
    return std::nullopt;
  BranchPoint corner = row(at, PointType::regime_switch);
  corner.arrival = direction_to(corner);
  // A parabola in between.
  if (!turns) corner.arrival = 2 * corner.arrival - curve_.points.back().tangent;
  corner.arrival /= steps(corner.arrival, corner).norm();
  corner.tangent = corner.arrival;
  const Vector arrival = corner.arrival;
  add(std::move(corner));
  if (told_to_end_) return std::nullopt;
  return Place{at, at.regime, arrival, {}};
}

}  // namespace arcslip::continuation
