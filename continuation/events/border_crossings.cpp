// The end of a regime.

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <vector>

#include "arcslip/continuation/events/step_search.hpp"
#include "arcslip/zero_between.hpp"

namespace arcslip::continuation {
namespace {

/// A function of the branch within the step: positive before its zero and negative behind it, or the other
/// way round.
struct Bracket {
  double upper;     ///< the zero lies in (0, upper)
  double at_zero;   ///< value at 0; noise if the step begins on the border
  int before;       ///< sign before the zero
  double at_upper;  ///< of the other sign
};

/// Locates the zero. Where the value at 0 may be noise, a point that shows the sign before the zero is looked
/// for.
template <class Function>
Zero locate(Stepper& stepper, const Bracket& bracket, Function f) {
  bool solved = true;
  const auto along = [&](double s) {
    solved = solved && stepper.prober().probe(s);
    return solved ? f(stepper) : 0.0;
  };
  double lower = 0;
  double at_lower = bracket.at_zero;
  if (sign_of(at_lower) != bracket.before || std::abs(at_lower) < 0.01 * std::abs(bracket.at_upper)) {
    double s = 0.5 * bracket.upper;
    double value = along(s);
    while (solved && sign_of(value) != bracket.before && s > 1e-12 * bracket.upper) value = along(s *= 0.5);
    if (!solved) return {Zero::State::failed};
    if (sign_of(value) == bracket.before) {
      lower = s;
      at_lower = value;
    } else if (sign_of(at_lower) != bracket.before) {
      // No zero in sight, or the step begins on it, by the last bits behind it.
      const bool begins_there = std::abs(at_lower) < 1e-6 * std::abs(bracket.at_upper);
      return {begins_there ? Zero::State::found : Zero::State::absent, 0};
    }
  }
  const double s = zero_between(along, lower, bracket.upper, at_lower, bracket.at_upper);
  return {solved ? Zero::State::found : Zero::State::failed, s};
}

/// Of a step that begins on the border and goes nowhere inside, it is where the value leaves rounding.
Zero locate_border(Stepper& stepper, std::size_t m, double upper, double value) {
  const double at_zero = stepper.step().from[m].value;
  const double on_border = stepper.tolerances().on_border;
  const auto where_it_is = [&](double level) {
    return locate(stepper, {upper, at_zero - level, -1, value - level},
                  [=](Stepper& s) { return s.prober().probed().monitors[m].value - level; });
  };
  const Zero zero = where_it_is(0);
  const bool at_once = zero.state == Zero::State::found && zero.s == 0 && std::abs(at_zero) <= on_border;
  return at_once && value > on_border ? where_it_is(on_border) : zero;
}

/// Whether a function that rises and then falls again along a piece stays below zero by far: four times as
/// high as where the tangents of its ends meet, above which it does not come where it is concave.
bool stays_low(const Monitor& from, const Monitor& to, double length) {
  constexpr double sure = 4;
  const double place = (to.value - from.value - to.slope * length) / (from.slope - to.slope);
  const double higher = std::max(from.value, to.value);
  const double top = from.value + from.slope * place;
  return place > 0 && place < length && higher + sure * (top - higher) < 0;
}

/// Where the branch crosses a border of its regime up to a place of the step, where its function is `to`. A
/// branch that comes beyond it by less than the tolerance, as where it all but touches it, stays inside.
Zero border_crossing(Stepper& stepper, std::size_t m, double upper, const Monitor& to) {
  const double touch = stepper.tolerance();
  const double on_border = stepper.tolerances().on_border;
  const Monitor from = stepper.step().from[m];
  double value = to.value;
  if (value <= on_border || (value <= touch && to.slope < 0)) {
    if (!(from.slope > 0 && to.slope < 0) || stays_low(from, to, upper)) return {Zero::State::absent};
    const Zero top = locate(stepper, {upper, from.slope, 1, to.slope},  // the border function's highest point
                            [m](Stepper& s) { return s.prober().probed().monitors[m].slope; });
    if (top.state != Zero::State::found || !stepper.prober().probe(top.s)) return {Zero::State::failed};
    upper = top.s;
    value = stepper.prober().probed().monitors[m].value;
    if (value <= touch) return {Zero::State::absent};
  }
  const bool begins_beyond = from.value > on_border && from.value <= touch && from.slope > 0;
  if (begins_beyond) return {Zero::State::found, 0};
  const Zero zero = locate_border(stepper, m, upper, value);
  // Beyond the border, yet nowhere across it.
  return zero.state == Zero::State::absent ? Zero{Zero::State::failed} : zero;
}

/// The borders in the order in which they are probably crossed: by straight lines.
std::vector<std::size_t> in_order(const Stepper& stepper) {
  const Step& step = stepper.step();
  const auto first = static_cast<std::size_t>(stepper.monitors().tracked_count());
  std::vector<std::size_t> order(step.to.size() - first);
  std::iota(order.begin(), order.end(), first);
  const auto place = [&](std::size_t m) {
    return step.to[m].value > 0 ? step.from[m].value / (step.from[m].value - step.to[m].value) : 1;
  };
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return place(a) < place(b); });
  return order;
}

/// Whether a value jumps over its zero there, between two branches, from one of which the probes have come to
/// the other: over a way it then changes by less than it is off zero, or as much over a hundredth of the way.
bool jumps(Stepper& stepper, std::size_t m, double s, double value) {
  constexpr double way = 1e-12;  // so little that steep values are far from their ends
  const auto value_at = [&](double place) -> std::optional<double> {
    if (!stepper.prober().probe(place)) return std::nullopt;
    return stepper.prober().probed().monitors[m].value;
  };
  const std::optional<double> far = value_at((1 - way) * s);
  const std::optional<double> near = value_at((1 - 0.01 * way) * s);
  if (!far || !near) return true;
  const double change = std::abs(value - *far);
  return change < std::abs(value) || std::abs(value - *near) > 0.5 * change;
}

/// One border after the other, up to the first place that is known: where there are many a step passes some,
/// of which all but one are looked for in vain. Those that are reached together there are looked for in all
/// of the step.
void search_borders(StepSearch& step) {
  Stepper& stepper = step.stepper;
  const double together = stepper.tolerances().together;
  const auto first = static_cast<std::size_t>(stepper.monitors().tracked_count());
  std::vector<Monitor> ahead = stepper.step().to;
  double upper = step.upper();
  std::optional<std::size_t> reached;
  for (const std::size_t m : in_order(stepper)) {
    const bool at_upper = reached && std::abs(ahead[m].value) <= together;
    const Zero zero = at_upper ? border_crossing(stepper, m, stepper.step().distance, stepper.step().to[m])
                               : border_crossing(stepper, m, upper, ahead[m]);
    if (zero.state == Zero::State::failed) return step.fail();
    if (zero.state == Zero::State::absent) continue;
    step.note({&border_crossings, PointType::regime_switch, static_cast<Index>(m - first), zero.s});
    if (reached && step.upper() == upper) continue;
    reached = m;
    upper = step.upper();
    if (!stepper.prober().probe(upper)) return step.fail();
    ahead = stepper.prober().probed().monitors;
  }
  if (!reached) return;
  if (!stepper.prober().probe(upper)) return step.fail();
  const Monitor border = stepper.prober().probed().monitors[*reached];
  const double rounding = stepper.monitors().rounding(stepper.here(), border.slope);
  if (std::abs(border.value) > std::max(together, rounding) &&
      (jumps(stepper, *reached, upper, border.value) || !stepper.prober().probe(upper)))
    return step.fail();
  if (stepper.roughness(upper, stepper.prober().probed().monitors) > 1) step.fail();
}

}  // namespace

/// The next piece has signs of its own.
const EventKind border_crossings{search_borders, [](const Event&, const Passage&) {}, {}, true};

}  // namespace arcslip::continuation
