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

/// Pairs of them are left to the step, which has to resolve the observable.
void search_extrema(StepSearch& step) {
  for (Index i = 0; i < step.stepper.monitors().tracked_count() && step.solved(); ++i) {
    const auto m = static_cast<std::size_t>(i);
    const std::size_t slope = step.readings.slope(i);
    const int before = step.signs.observables[m];
    const double after = step.at_upper(slope, sign_of_slope(step.stepper, m, step.stepper.step().to[m]));
    const bool changes = before * sign_of(after) < 0 || ends_on_extremum(step, slope, before);
    if (changes && step.stepper.is_near_meeting()) continue;
    const bool is_rough = changes && step.stepper.has_rough_extrema();
    const Step& taken = step.stepper.step();
    step.note(observable_extrema, before > 0 ? PointType::peak : PointType::trough, i,
              is_rough ? where_line_vanishes(taken.from[m].slope, step.at_upper(slope, taken.to[m].slope),
                                             step.upper())
                       : step.turn(slope, before, changes));
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
