// Extrema of the tracked observables.

#include "arcslip/continuation/events/step_search.hpp"

namespace arcslip::continuation {
namespace {

/// Pairs of them are left to the step, which has to resolve the observable.
void search_extrema(StepSearch& step) {
  for (Index i = 0; i < step.stepper.monitors().tracked_count() && step.solved(); ++i) {
    const auto m = static_cast<std::size_t>(i);
    const std::size_t slope = step.readings.slope(i);
    const int before = step.signs.observables[m];
    const double after = step.at_upper(slope, sign_of_slope(step.stepper, m, step.stepper.step().to[m]));
    step.note(observable_extrema, before > 0 ? PointType::peak : PointType::trough, i,
              step.turn(slope, before, before * sign_of(after) < 0));
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
