// What a branch takes from the events that a step ends at.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "arcslip/continuation/path/repetition.hpp"
#include "arcslip/continuation/path/tracer.hpp"

namespace arcslip::continuation {
namespace {

/// Whether one of these is a zero of a function of pieces, which is taken for a corner of the branch.
bool is_corner(const std::vector<Event>& events, const Watch& watch) {
  return std::any_of(events.begin(), events.end(), [&](const Event& event) {
    return event.type == PointType::event && watch.piece_of(static_cast<std::size_t>(event.index));
  });
}

/// d(u, p_a)/d arclength of the piece that arrives at a corner just before `stepper` stands; empty where it
/// cannot be told.
Vector arrival_at_corner(Stepper& stepper, Corrector& corrector, double last_chord) {
  constexpr double just_before = 1e-9;  // of the way from the last point: events are nearer to their corner
  const CurvePoint& here = stepper.here();
  if (stepper.prober().linearise_beside(here, here.tangent, -just_before * last_chord) !=
      Correction::converged)
    return {};
  return corrector.direction().normalized().cwiseProduct(here.scale);
}

}  // namespace

/// A zero but for rounding is one of neither piece, or of both: it is told once, and behind it the sign is
/// that of what follows.
void Tracer::user_events_on_corner(const Signs& before, const std::vector<double>& sizes) {
  constexpr double rounding = 1e-14;  // of what the function comes from
  const auto is_told = [&](const std::string& label) {
    for (auto row = branch_.points.rbegin(); row != branch_.points.rend(); ++row) {
      if (row->arclength != state_.arclength) return false;
      if (row->type == PointType::event && row->label == label) return true;
    }
    return false;
  };
  for (std::size_t i = 0; i < watch_.searched(); ++i) {
    const bool vanishes = std::abs(watch_.functions()[i]) <= rounding * sizes[i];
    if (watch_.type(i) != PointType::event || watch_.piece_of(i) || !vanishes) continue;
    state_.signs.functions[i] = 0;
    if (before.functions[i] != 0 && !is_told(watch_.label(i))) store(PointType::event, watch_.label(i));
  }
}

/// Whether a point all but has symmetries that it has not.
bool Tracer::meets(const CurvePoint& point) const {
  constexpr double near = 0.02;  // in the scale: steps are longer
  const auto count = [&](double tolerance) {
    const std::vector<bool> kept = kept_symmetries(options_.symmetries, point.unknowns,
                                                   point.scale.head(point.unknowns.size()), tolerance);
    return std::count(kept.begin(), kept.end(), true);
  };
  return count(near) > count(options_.tolerances.same_solution);
}

/// On a branch that winds no step may pass more than one turn: two would not show in how the parameter runs
/// at its ends.
double Tracer::longest_step() const {
  constexpr double to_next = 1.4;  // of the way between the last two folds
  const bool winds = state_.arclength - state_.fold < 2 * state_.winding;
  return winds ? std::clamp(to_next * state_.winding, options_.min_step, options_.max_step)
               : options_.max_step;
}

/// Whether other borders are reached together with the one that was located, but for rounding, and something
/// lies beyond one of them.
bool Tracer::on_several_borders() const {
  const CurvePoint& here = stepper_.here();
  int reached = 0;
  bool leads_on = false;
  for (int border = 0; border < problem_.border_count(here.regime); ++border) {
    const double value = problem_.border(here.unknowns, here.parameters, here.regime, border, nullptr);
    if (!(std::abs(value) <= options_.tolerances.together)) continue;
    ++reached;
    leads_on = leads_on || problem_.regime_beyond(here.regime, border);
  }
  return reached > 1 && leads_on;
}

/// Whether the step has events to tell before it comes to the start at s. Those that are there, but for how
/// well both are located, were told as the branch began, or are taken to be where its points are not here; a
/// border there is none that it goes over.
bool Tracer::is_told_before(double s) const {
  if (events_.empty() || events_.front().s >= s) return false;
  const double same = options_.tolerances.same_point;
  if ((s - events_.front().s) * stepper_.step().slope_from.norm() > same) return true;
  if (branch_.points.empty() || branch_.points.front().arclength > same) return false;
  const auto began_with = [&](const Event& event) {
    return std::any_of(branch_.points.begin(), branch_.points.end(), [&](const BranchPoint& point) {
      if (point.arclength > same) return false;
      if (event.type == PointType::fold) return is_turn(point.type);
      return point.type == event.type && (event.type != PointType::event ||
                                          point.label == watch_.label(static_cast<std::size_t>(event.index)));
    });
  };
  return std::any_of(events_.begin(), events_.end(), [&](const Event& event) {
    return event.told && !event.kind->ends_regime && !began_with(event);
  });
}

/// Where nothing but rounding is passed.
void Tracer::stop_in_place() {
  if (turns_in_place(branch_.points, options_.tolerances))
    stop(
        Stop::repeats,
        fmt::format("the branch turns again and again at {}: a corner or rounding that its steps do not pass",
                    place()));
}

/// Where no step is acceptable: on a border that nothing leads beyond, but for rounding, to which a branch
/// comes no nearer where its solutions are double there.
void Tracer::stop_stepping() {
  const CurvePoint& here = stepper_.here();
  for (int border = 0; border < problem_.border_count(here.regime); ++border) {
    const double value = problem_.border(here.unknowns, here.parameters, here.regime, border, nullptr);
    if (!(std::abs(value) <= options_.tolerances.same_point) || problem_.regime_beyond(here.regime, border))
      continue;
    store(PointType::end);
    return stop(Stop::left_regime,
                fmt::format("the branch ends on the border of its regime but for rounding, at {}", place()));
  }
  const Correction last = stepper_.last_correction();
  stop(last == Correction::cannot_evaluate ? Stop::no_value : Stop::min_step,
       fmt::format("no step of at least min_step = {:g} is acceptable from {}: {}", options_.min_step,
                   place(), reason(last)));
}

void Tracer::take_events(const Signs& before) {
  const CurvePoint& here = stepper_.here();
  const Passage passage{before, state_.signs, stepper_, watch_};
  state_.signs.unstable = before.unstable;
  const bool at_corner = is_corner(events_, watch_);
  Vector arrival;
  if (at_corner) arrival = arrival_at_corner(stepper_, corrector_, state_.last_chord);
  for (const Event& event : events_) {
    event.kind->pass(event, passage);
    if (event.kind->ends_regime || !event.told) continue;
    const bool of_value =
        event.type == PointType::peak || event.type == PointType::trough || event.type == PointType::event;
    state_.signs.at_crossing = state_.signs.at_crossing || !of_value;
    if (event.type == PointType::fold) {
      state_.winding = std::isnan(state_.fold) ? 0 : state_.arclength - state_.fold;
      state_.fold = state_.arclength;
    }
    store(
        event.type == PointType::fold ? problem_.turn(here.unknowns, here.parameters, here.regime)
                                      : event.type,
        event.type == PointType::event ? watch_.label(static_cast<std::size_t>(event.index)) : std::string(),
        std::exchange(arrival, {}));
    if (const auto known = came_round(problem_, branch_.points, parameter_, options_.tolerances))
      stop(Stop::repeats, "the branch came back to its point " + std::to_string(*known) +
                              " and not to its start: a step had gone over to another branch");
    stop_in_place();
    // Others may stand for a while, as sliding does under the force that it needs, and go on.
    if (!options_.symmetries.empty() &&
        stands_still(problem_, branch_.points, parameter_, options_.tolerances))
      stop(Stop::repeats, "along the branch " + options_.parameter + " does not change but for rounding");
  }
  // Where several vanish together the order of rounding tells which, and the count may be too low.
  if (before.unstable >= 0) state_.signs.unstable = std::max(state_.signs.unstable, 0);
  if (stopped_) return;
  // At a corner an observable may turn, and turn again before the next step ends.
  for (std::size_t i = 0; i < before.observables.size() && at_corner; ++i) {
    const int behind = sign_of_slope(stepper_, i, stepper_.at_here()[i]);
    int& sign = state_.signs.observables[i];
    if (sign != before.observables[i] || sign * behind >= 0) continue;
    sign = behind;
    store(behind < 0 ? PointType::peak : PointType::trough);
  }
  const auto end = std::find_if(events_.begin(), events_.end(),
                                [](const Event& event) { return event.kind->ends_regime; });
  if (end != events_.end()) cross(static_cast<int>(end->index), on_several_borders());
  if (stopped_) return;
  if (state_.arclength > 0) take_targets_around(before.parameter * state_.signs.parameter < 0);
}

}  // namespace arcslip::continuation
