// Values of the parameter on which a branch puts a point.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "arcslip/continuation/path/tracer.hpp"

namespace arcslip::continuation {
namespace {

constexpr double long_step = 0.01;  // of a chord: before a turn it is as short as the root of a gap

/// Whether a value has all but vanished over a step, as it must where its zero is as near to the end as
/// values are one.
bool vanishes(double from, double to) {
  constexpr double little = 0.01;
  return std::abs(to) <= little * std::abs(from);
}

bool ends_near_turn(const Step& step) {
  return vanishes(parameter_rate(step.here), parameter_rate(step.there));
}

/// The same of all else that is looked for.
bool ends_near_zero(const Stepper& stepper, Watch& watch) {
  const Step& step = stepper.step();
  if (vanishes(1, std::exp(step.there.log_determinant - step.here.log_determinant))) return true;
  const auto tracked = static_cast<std::size_t>(stepper.monitors().tracked_count());
  for (std::size_t m = 0; m < step.to.size(); ++m) {
    if (m < tracked ? vanishes(step.from[m].slope, step.to[m].slope)
                    : vanishes(step.from[m].value, step.to[m].value))
      return true;
  }
  if (watch.empty()) return false;
  watch.look(step.there);
  const Look& here = watch.kept().front();
  for (std::size_t i = 0; i < watch.searched(); ++i) {
    if (vanishes(here.functions[i], watch.functions()[i])) return true;
  }
  const std::size_t rates = std::min(here.rates.size(), static_cast<std::size_t>(watch.eigenvalues().size()));
  for (std::size_t i = 0; i < rates; ++i) {
    if (vanishes(here.rates[i], watch.eigenvalues()(static_cast<Index>(i)).real())) return true;
  }
  return false;
}

}  // namespace

/// A start on a special point lies on a value but for rounding, and no step of that length can be made from
/// it. On an end of the range no branch that starts there has come back to it.
void Tracer::take_where_it_starts(bool is_special) {
  for (const Target* target : targets_.around(value(), options_.tolerances.on_target * parameter_scale())) {
    if (is_special || target->kind != Target::Kind::user) targets_.take(*target);
  }
}

/// Of a step that was not brought to its end, so that it is tried again in the same way.
void Tracer::forget_tries() {
  state_.hold = first_hold_;
  state_.distance = first_distance_;
  targets_.keep_taken(value(), -1);
  targets_.restore(first_taken_);
}

bool Tracer::try_landing() {
  const auto lands = [this] { return stepper_.attempt_landing(landing_->value) && find_events(); };
  const auto ends_at_event = [this](Hold hold, double distance) {
    return stepper_.attempt(hold, distance) && find_events() && (!events_.empty() || closing_);
  };
  const bool has_landed = lands();
  const double distance = stepper_.step().distance;
  const bool is_end = landing_->kind == Target::Kind::end || landing_->kind == Target::Kind::bound;
  if (has_landed) {
    if (!is_end || !events_.empty() || closing_) return true;
    // From a special point on, where something is zero, nothing is told by how little of it is left. Of the
    // point that a resumed branch begins with it is not known whether it is one.
    const bool may_be_special = branch_.points.empty() || branch_.points.back().type != PointType::regular;
    const bool may_turn = ends_near_turn(stepper_.step());
    if (!may_turn && !may_be_special && !ends_near_zero(stepper_, watch_)) return true;
    // What lies on the end is behind it by the last digit or before it, and no further step would tell it.
    constexpr double most_of_it = 0.9;
    const double behind = distance + most_of_it * options_.tolerances.same_value;
    if (!may_turn && (ends_at_event(Hold::parameter, behind) || lands())) return true;
  }
  // A special point at the very value, where the parameter cannot be kept, is stepped over and located. To a
  // turn it is twice as far as the slope tells; so near to the end nothing else keeps a step from it.
  constexpr double near = 1e-6;
  const double reach = is_end && (has_landed || distance <= near) ? 3 : 1.5;
  const double beyond = reach * distance / std::abs(stepper_.parameter_slope(Hold::tangent));
  if (ends_at_event(Hold::tangent, beyond)) {
    use(Hold::tangent);  // at a fold the parameter cannot be kept
    return true;
  }
  if (has_landed && lands()) return true;
  landing_failed_ = true;
  rest_before(*landing_);
  use(Hold::parameter);
  state_.distance = 0.5 * distance;
  return false;
}

/// The next value to land on within `reach`, or one that the branch seems to approach only: on this it is
/// tried once whether it lies there at last. From a scale that shrinks with the parameter 0 is in no other
/// reach.
const Target* Tracer::next_target(double reach, double direction) const {
  const double least = options_.tolerances.on_target * parameter_scale();
  const Target* next = targets_.ahead(value(), direction, reach, least);
  if (next != nullptr || landing_failed_) return next;
  const double near = options_.tolerances.same_value * std::max(parameter_scale(), start_scale());
  next = targets_.ahead(value(), direction, near, least);
  return next != nullptr && only_approaches(*next) ? next : nullptr;
}

/// Whether the branch is as near to a value as can be told, and yet its last step came nearer by a factor
/// only, however long it was. Before a fold it would have been as short as the root of the gap.
bool Tracer::only_approaches(const Target& target) const {
  constexpr double most_of_it = 0.1;
  const double gap = std::abs(target.value - value());
  const double scale = target.value == 0 ? start_scale() : parameter_scale();
  return gap <= options_.tolerances.same_value * scale &&
         gap >= most_of_it * std::abs(target.value - state_.last_value) && state_.last_chord >= long_step;
}

/// Whether the last step halved the gap to a value on which none had landed, was long and yet bent away from
/// it: so a branch comes near to what it never reaches, and a landing would be lost again.
bool Tracer::comes_by_halves(const Target& target) const {
  constexpr double same = 1e-6;
  constexpr double bends = 1.2;  // times the last step: what falls exponentially does by 1 / ln 2
  const double gap = std::abs(target.value - value());
  const bool has_halved = std::abs(gap - std::abs(value() - state_.last_value)) <= same * gap;
  if (!has_halved || state_.last_chord < long_step || only_approaches(target)) return false;
  const double way = gap / (parameter_scale() * std::abs(stepper_.parameter_slope(Hold::tangent)));
  return way > bends * state_.last_chord;
}

void Tracer::halve_way_to(const Target& target) {
  use(Hold::parameter);
  state_.distance = std::min(0.5 * std::abs(target.value - value()) / parameter_scale(),
                             longest_step() / stepper_.slope_length(state_.hold));
}

/// Where no step lands on a value that is within rounding, the branch has reached it; one that it only
/// approaches it never will.
void Tracer::rest_before(const Target& target) {
  if (std::abs(target.value - value()) <= options_.tolerances.on_target * parameter_scale())
    return take_target(target);
  if (!only_approaches(target)) return;
  // A branch may climb beside a landmark as if it never reached it, and needs no point on it.
  if (target.kind == Target::Kind::landmark) return targets_.take(target);
  stop(Stop::asymptotic, fmt::format("the branch comes ever nearer to {} = {:.10g} without a point on it; "
                                     "it stands at {}",
                                     options_.parameter, target.value, place()));
}

/// Whether a target lies between here and a point of the step, further than `tolerance` from this. Then the
/// step has to land on it first.
bool Tracer::passes_target(const CurvePoint& point, double tolerance) const {
  return targets_.between(value(), point.parameters(parameter_), tolerance * parameter_scale(),
                          options_.tolerances.same_value * parameter_scale());
}

/// Takes the values at an event on which no point will be put: those that it lies on, that the step has
/// passed, or that lie beyond a turn. At a turn on its first value, but for how well it is located, a branch
/// goes back into the range.
void Tracer::take_targets_around(bool turns) {
  if (turns) targets_.keep_taken(value(), options_.tolerances.on_target * parameter_scale());
  for (const Target* target : targets_.around(value(), options_.tolerances.same_value * parameter_scale())) {
    const double beyond = target->value - value();
    const bool is_bound = target->kind == Target::Kind::bound;
    if (is_bound && turns) {
      targets_.take(*target);
      continue;
    }
    const bool is_here = std::abs(beyond) <= options_.tolerances.on_target * parameter_scale();
    const bool is_passed = (target->value - state_.last_value) * beyond < 0;
    const bool is_missed = turns && beyond * (value() - state_.last_value) > 0;
    if (is_passed || is_missed || is_here) take_target(*target);
    if (stopped_) return;
  }
}

void Tracer::take_target(const Target& target) {
  targets_.take(target);
  if (target.kind == Target::Kind::landmark) return store(PointType::regular);
  if (target.kind == Target::Kind::user) return store(PointType::user);
  store_turn();
  store(PointType::end);
  if (target.kind == Target::Kind::end) return stop(Stop::reached_end, "the last value was reached");
  stop(Stop::left_range, "the branch came back to its first value");
}

/// What a landing on the very value of a turn is, where that is more than that the parameter stands still.
void Tracer::store_turn() {
  const CurvePoint& here = stepper_.here();
  if (std::abs(stepper_.parameter_slope(Hold::tangent)) > options_.tolerances.off_by_rounding) return;
  const PointType turn = problem_.turn(here.unknowns, here.parameters, here.regime);
  if (turn != PointType::fold) store(turn);
}

/// A distance, a little shorter, to a value of the parameter that hangs little on where the step begins: so
/// that rounding of the places of special points does not move all points behind them, to where on the flank
/// of a needle the response is another.
double Tracer::to_even_value(double distance, double rate) const {
  constexpr double parts = 64;  // of the step
  const double way = distance * parameter_scale();
  const double unit = std::exp2(std::floor(std::log2(way))) / parts;
  const double end =
      rate > 0 ? std::floor((value() + way) / unit) * unit : std::ceil((value() - way) / unit) * unit;
  const double even = std::abs(end - value()) / parameter_scale();
  return even > 0.5 * distance ? even : distance;
}

/// Whether a step leads out of the range from a point that lies on its limit but for rounding, on which no
/// further step could land.
bool Tracer::leaves_range() const {
  const double beyond = stepper_.step().there.parameters(parameter_);
  const double same = options_.tolerances.same_value * parameter_scale();
  const auto [low, high] = std::minmax(options_.from, options_.to);
  return (beyond < low && value() <= low + same) || (beyond > high && value() >= high - same);
}

}  // namespace arcslip::continuation
