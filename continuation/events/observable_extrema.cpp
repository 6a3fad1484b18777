// Extrema of the tracked observables.

#include <algorithm>
#include <cmath>
#include <optional>

#include "arcslip/continuation/events/step_search.hpp"

namespace arcslip::continuation {
namespace {

/// Where a slope vanishes that is a line between the ends of a step, aside from both.
Zero where_line_vanishes(double from, double to, double upper) {
  constexpr double off_ends = 0.01;  // of the step
  const double part = from * to < 0 ? from / (from - to) : 0;
  return {Zero::State::found, upper * std::clamp(part, off_ends, 1 - off_ends)};
}

/// Whether the event at which the search ends is one of these as well, but for rounding, or for how well
/// branch points are located: just behind these no step can begin. At a cusp `turn` tells.
bool ends_on_extremum(StepSearch& step, std::size_t slope, int before) {
  if (!step.ends_at_event() || step.has(PointType::cusp)) return false;
  const auto& crossing = step.stepper.step().crossing;
  const bool is_branch_point = crossing && crossing->s == step.upper();
  const double near = is_branch_point ? step.tolerances.just_passed : step.tolerances.located;
  const std::optional<double> here = step.readings.value(slope, 0);
  const std::optional<double> there = step.readings.value(slope, step.upper());
  if (!here || !there || std::abs(*there) > near * std::abs(*here)) return false;
  const std::optional<Node> node = step.readings.node(slope, step.upper());
  return node && before * node->slope < 0;
}

/// A slope at a place of the step, and on which piece of the observable that is.
struct SlopeAt {
  double s, value, piece;
  bool keeps = false;  ///< its sign, on the way to the corner
};

/// Where the greatest, or least, of several functions is another one at the end than where it begins: the
/// corner between them, at which the slope leaps, may hide an extremum there, with one of a function beside
/// it, from the signs at both ends. It is closed in until the slopes on both sides are too large to vanish.
Zero beside_corner(StepSearch& step, Index observable, int before) {
  constexpr double finest = 1e-3;       // of the step
  constexpr double just_behind = 1e-6;  // the same: where it begins on a corner
  constexpr double surely = 4;
  const ZeroSearch::PiecewiseFunction of{step.readings.slope(observable), step.readings.piece(observable)};
  const auto at = [&](double s) -> std::optional<SlopeAt> {
    const std::optional<double> slope = step.readings.value(of.value, s);
    const std::optional<double> piece = step.readings.value(of.piece, s);
    return slope && piece ? std::optional(SlopeAt{s, *slope, *piece}) : std::nullopt;
  };
  std::optional<SlopeAt> low = at(0);
  if (low && sign_of(low->value) != before) low = at(just_behind * step.upper());
  std::optional<SlopeAt> high = at(step.upper());
  const bool is_told = low && high && sign_of(low->value) == before && low->piece != high->piece;
  while (is_told && !(low->keeps && high->keeps) && high->s - low->s > finest * step.upper()) {
    std::optional<SlopeAt> middle = at(0.5 * (low->s + high->s));
    if (!middle) return {Zero::State::absent};
    if (sign_of(middle->value) == -before)
      return ZeroSearch(step.stepper, step.readings).first_of_pieces(of, before, false, low->s, middle->s);
    SlopeAt& end = middle->piece == low->piece ? *low : *high;
    // The way that is left is as wide as that to the end before.
    middle->keeps =
        middle->piece == end.piece && std::abs(middle->value) > surely * std::abs(middle->value - end.value);
    end = *middle;
  }
  return {Zero::State::absent};
}

/// The first of them, as the signs at both ends of the step tell, or, beside a corner, those in between.
Zero first_extremum(StepSearch& step, std::size_t m, int before, bool changes) {
  const auto i = static_cast<Index>(m);
  const std::size_t slope = step.readings.slope(i);
  const Step& taken = step.stepper.step();
  const bool is_rough = step.stepper.has_rough_extrema();
  if (changes && is_rough)
    return where_line_vanishes(taken.from[m].slope, step.at_upper(slope, taken.to[m].slope), step.upper());
  const Zero zero = step.turn(slope, before, changes);
  const bool has_corner = taken.from[m].piece != taken.to[m].piece;
  if (before == 0 || changes || zero.state != Zero::State::absent || !has_corner || is_rough) return zero;
  return beside_corner(step, i, before);
}

/// Whether an observable has just turned, so that this zero of its slope is rounding, as next to a fold of a
/// ridge, with which it turns.
bool has_just_turned(const StepSearch& step, std::size_t m, const Zero& zero) {
  if (zero.state != Zero::State::found) return false;
  const Step& taken = step.stepper.step();
  const double chord = taken.chord.norm();
  const double last_steps = taken.past.empty() ? 0 : taken.past.back().behind;
  const double way = step.signs.since[m] + chord * zero.s / taken.distance;
  return way <= step.tolerances.just_passed * (last_steps + chord);
}

/// Pairs of them on one piece are left to the step, which has to resolve the observable.
void search_extrema(StepSearch& step) {
  for (Index i = 0; i < step.stepper.monitors().tracked_count() && step.solved(); ++i) {
    const auto m = static_cast<std::size_t>(i);
    const std::size_t slope = step.readings.slope(i);
    const int before = step.signs.observables[m];
    const double after = step.at_upper(slope, sign_of_slope(step.stepper, m, step.stepper.step().to[m]));
    const bool changes = before * sign_of(after) < 0 || ends_on_extremum(step, slope, before);
    if (changes && step.stepper.is_near_meeting()) continue;
    const Zero zero = first_extremum(step, m, before, changes);
    if (!has_just_turned(step, m, zero))
      step.note(observable_extrema, before > 0 ? PointType::peak : PointType::trough, i, zero);
  }
}

void pass_extremum(const Event& event, const Passage& passage) {
  const auto i = static_cast<std::size_t>(event.index);
  passage.behind.observables[i] = -passage.before.observables[i];
  passage.behind.since[i] = 0;
}

}  // namespace

/// An observable that depends on the parameters alone turns at a cusp.
const EventKind observable_extrema{search_extrema, pass_extremum, {PointType::cusp}};

}  // namespace arcslip::continuation
