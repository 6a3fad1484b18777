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

/// The first of them, as the signs at both ends of the step tell, or, where the greatest of several functions
/// is another one at the end, as these do beside the corners between.
Zero first_extremum(StepSearch& step, std::size_t m, int before, double after, bool changes) {
  const auto i = static_cast<Index>(m);
  const std::size_t slope = step.readings.slope(i);
  const Step& taken = step.stepper.step();
  const bool is_rough = step.stepper.has_rough_extrema();
  if (changes && is_rough) return where_line_vanishes(taken.from[m].slope, after, step.upper());
  const Zero zero = step.turn(slope, before, changes);
  const bool has_corner = taken.from[m].piece != taken.to[m].piece;
  if (before == 0 || changes || zero.state != Zero::State::absent || !has_corner || is_rough) return zero;
  constexpr double just_behind = 1e-6;  // of the step: where it begins on a corner
  double from = 0;
  if (sign_of(step.readings.value(slope, from).value_or(0)) != before) from = just_behind * step.upper();
  if (sign_of(step.readings.value(slope, from).value_or(0)) != before) return zero;
  return ZeroSearch(step.stepper, step.readings)
      .first_of_pieces({slope, step.readings.piece(i)}, before, false, from, step.upper());
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
    step.note(
        observable_extrema, before > 0 ? PointType::peak : PointType::trough, i,
        first_extremum(step, m, before, step.at_upper(slope, step.stepper.step().to[m].slope), changes));
  }
}

void pass_extremum(const Event& event, const Passage& passage) {
  const auto i = static_cast<std::size_t>(event.index);
  passage.behind.observables[i] = -passage.before.observables[i];
}

}  // namespace

/// An observable that depends on the parameters alone turns at a cusp.
const EventKind observable_extrema{search_extrema, pass_extremum, {PointType::cusp}};

}  // namespace arcslip::continuation
