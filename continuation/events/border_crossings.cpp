// The end of a regime.

#include <algorithm>
#include <cmath>
#include <utility>
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
  double slope;     ///< there; nan of a function whose slopes are not known
};

/// The zero between two places at which `along` has opposite signs, to its last bits: Newton's method by the
/// slope along the branch, kept between them. Points on its way are kept, for the next to be found from.
template <class Along>
double newton_between(Stepper& stepper, const Along& along, Node low, Node high) {
  constexpr double last_bits = 1e-15;
  constexpr int most_rounds = 100;
  double s = zero_of_cubic(low, high);
  for (int round = 0; round < most_rounds; ++round) {
    const double within = last_bits * high.s;
    if (!(s > low.s + within && s < high.s - within)) s = 0.5 * (low.s + high.s);
    if (!(high.s - low.s > 4 * within)) break;
    const Monitor here = along(s);
    if (here.value == 0) break;
    stepper.prober().anchor();
    Node& same = here.value * low.value > 0 ? low : high;
    same = {s, here.value, here.slope};
    const double next = s - here.value / here.slope;
    if (std::abs(next - s) <= within) break;
    s = next;
  }
  return s;
}

/// Locates the zero. Where the value at 0 may be noise, a point that shows the sign before the zero is looked
/// for.
template <class Function>
Zero locate(Stepper& stepper, const Bracket& bracket, Function f) {
  bool solved = true;
  const auto there = [&](double s) {
    solved = solved && stepper.prober().probe(s);
    return solved ? f(stepper) : Monitor{};
  };
  const auto along = [&](double s) { return there(s).value; };
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
  const double s = std::isnan(bracket.slope)
                       ? zero_between(along, lower, bracket.upper, at_lower, bracket.at_upper)
                       : newton_between(stepper, there, {lower, at_lower, std::nan("")},
                                        {bracket.upper, bracket.at_upper, bracket.slope});
  return {solved ? Zero::State::found : Zero::State::failed, s};
}

/// Of a step that begins on the border and goes nowhere inside, it is where the value leaves rounding.
Zero locate_border(Stepper& stepper, std::size_t m, double upper, const Monitor& there) {
  const double value = there.value;
  const double at_zero = stepper.step().from[m].value;
  const double on_border = stepper.tolerances().on_border;
  const auto where_it_is = [&](double level) {
    return locate(stepper, {upper, at_zero - level, -1, value - level, there.slope}, [=](Stepper& s) {
      const Monitor& here = s.prober().probed().monitors[m];
      return Monitor{here.value - level, here.slope};
    });
  };
  const Zero zero = where_it_is(0);
  const bool at_once = zero.state == Zero::State::found && zero.s == 0 && std::abs(at_zero) <= on_border;
  return at_once && value > on_border ? where_it_is(on_border) : zero;
}

/// Where the branch crosses a border of its regime, the m-th monitor, up to a place of the step. A branch
/// that comes beyond it by less than the tolerance, as where it all but touches it, stays inside.
Zero border_crossing(Stepper& stepper, std::size_t m, double upper) {
  const double touch = stepper.tolerance();
  const double on_border = stepper.tolerances().on_border;
  if (!stepper.prober().probe(upper)) return {Zero::State::failed};
  const Monitor from = stepper.step().from[m];
  Monitor to = stepper.prober().probed().monitors[m];
  if (to.value <= on_border || (to.value <= touch && to.slope < 0)) {
    const Node begin{0, from.value, from.slope};
    const bool is_far = zeros_between(begin, {upper, to.value, to.slope}) == Zeros::none;
    if (!(from.slope > 0 && to.slope < 0) || is_far) return {Zero::State::absent};
    const auto slope = [m](Stepper& s) { return Monitor{s.prober().probed().monitors[m].slope, 0}; };
    const Zero top =  // the border function's highest point
        locate(stepper, {upper, from.slope, 1, to.slope, std::nan("")}, slope);
    if (top.state != Zero::State::found || !stepper.prober().probe(top.s)) return {Zero::State::failed};
    upper = top.s;
    to = stepper.prober().probed().monitors[m];
    if (to.value <= touch) return {Zero::State::absent};
  }
  const bool begins_beyond = from.value > on_border && from.value <= touch && from.slope > 0;
  if (begins_beyond) return {Zero::State::found, 0};
  const Zero zero = locate_border(stepper, m, upper, to);
  // Beyond the border, yet nowhere across it.
  return zero.state == Zero::State::absent ? Zero{Zero::State::failed} : zero;
}

/// The borders as the cubics between both ends of the step foretell that they are crossed.
std::vector<Index> in_order(const Step& step, Index first, Index count) {
  std::vector<std::pair<double, Index>> places;
  for (Index b = 0; b < count; ++b) {
    const auto m = static_cast<std::size_t>(first + b);
    const Node from{0, step.from[m].value, step.from[m].slope};
    const Node to{step.distance, step.to[m].value, step.to[m].slope};
    places.emplace_back(from.value * to.value < 0 ? zero_of_cubic(from, to) : step.distance, b);
  }
  std::sort(places.begin(), places.end());
  std::vector<Index> borders;
  for (const auto& [s, border] : places) borders.push_back(border);
  return borders;
}

/// Only the first of all crossings counts: each border is looked at up to that of those before.
void search_borders(StepSearch& step) {
  Stepper& stepper = step.stepper;
  const Index tracked = stepper.monitors().tracked_count();
  const auto count = static_cast<Index>(stepper.step().to.size()) - tracked;
  if (count == 0) return;
  for (const Index b : in_order(stepper.step(), tracked, count)) {
    const Zero zero = border_crossing(stepper, static_cast<std::size_t>(tracked + b), step.upper());
    step.note(border_crossings, PointType::regime_switch, b, zero);
    if (!step.solved()) return;
  }
  if (!step.ends_at_event()) return;
  if (!stepper.prober().probe(step.upper()) ||
      !stepper.resolved(step.upper(), stepper.prober().probed().monitors))
    step.fail();
}

}  // namespace

/// The next piece has signs of its own.
const EventKind border_crossings{search_borders, [](const Event&, const Passage&) {}, {}, true};

}  // namespace arcslip::continuation
