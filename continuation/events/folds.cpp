// Where the parameter turns.

#include "arcslip/continuation/events/step_search.hpp"

namespace arcslip::continuation {
namespace {

/// Two in one step, the second of which turns the parameter back, show in how far it has come; but from where
/// the branch turns itself, as at a pitchfork, the way there is not told by a slope.
void search_folds(StepSearch& step) {
  if (step.stepper.is_regular()) return;
  const int before = step.signs.parameter;
  const double after = step.at_upper(Readings::rate, step.stepper.step().parameter_rate_to());
  const bool turns = before * sign_of(after) < 0 || (before != 0 && step.stepper.step().may_turn_twice());
  step.note(folds, PointType::fold, 0, step.turn(Readings::rate, before, turns));
}

void pass_fold(const Event& event, const Passage& passage) {
  passage.behind.parameter = -passage.before.parameter;
  if (event.told) passage.behind.unstable += passage.real_crossings();
}

}  // namespace

/// A parameter turns at a pitchfork, and all that depends on the parameters alone at a cusp.
const EventKind folds{
    search_folds, pass_fold, {PointType::branch_point, PointType::cusp, PointType::bogdanov_takens}};

}  // namespace arcslip::continuation
