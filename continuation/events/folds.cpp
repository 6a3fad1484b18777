// Where the parameter turns.

#include <algorithm>
#include <cmath>

#include "arcslip/continuation/events/step_search.hpp"

namespace arcslip::continuation {
namespace {

/// Which way the parameter came: by how far it went, as each step of a branch that winds may begin on a fold;
/// of a way that is rounding, or that of a parameter that stands still, by its rate where that began.
int way_here(const StepSearch& search) {
  constexpr double hardly = 1e-12;
  const Step& step = search.stepper.step();
  if (step.past.empty()) return 0;
  const double standing = search.tolerances.no_rate * step.past.front().behind;
  return std::abs(step.moved) > std::max(hardly, standing)
             ? sign_of(step.moved)
             : sign_of_rate(search.stepper, step.past.front().rate / step.here.scale.tail(1)(0));
}

/// Whether the parameter has stood still up to where the step begins, and may have turned before.
bool has_stood(const StepSearch& search) {
  const double begin = search.stepper.step().parameter_rate_from();
  const int before = search.signs.parameter;
  return sign_of_rate(search.stepper, begin) == 0 && before * begin <= 0 &&
         !search.stepper.step().past.empty() && before * way_here(search) >= 0;
}

/// Whether the step begins on a fold.
bool has_turned(const StepSearch& search) { return search.signs.parameter * way_here(search) < 0; }

/// Whether what turns the parameter is the branch point up to which is searched, so near to which its rate is
/// rounding.
bool turns_at_branch_point(const StepSearch& search) {
  const auto& crossing = search.stepper.step().crossing;
  return crossing && crossing->s == search.upper() && crossing->slope(crossing->slope.size() - 1) == 0 &&
         search.signs.parameter * crossing->rate_behind < 0;
}

/// Two in one step, the second of which turns the parameter back, show in how far it has come; but from where
/// the branch turns itself, as at a pitchfork, the way there is not told by a slope. A parameter that has
/// stood still but for rounding has turned where it moves again; of one that turns on a fold again nothing
/// but rounding is told.
void search_folds(StepSearch& step) {
  if (step.stepper.is_regular()) return;
  const int before = step.signs.parameter;
  if (turns_at_branch_point(step)) {
    step.note(folds, PointType::fold, 0, Zero{Zero::State::found, step.upper()});
    return;
  }
  const double rate = step.at_upper(Readings::rate, step.stepper.step().parameter_rate_to());
  const int after = step.is_whole() ? sign_of_rate(step.stepper, rate) : sign_of(rate);
  const bool twice = before * after > 0;
  const bool turns = before * after < 0 || (twice && step.stepper.step().may_turn_twice());
  if (before * after < 0 && has_stood(step)) {
    step.note(folds, PointType::fold, 0, Zero{Zero::State::found, 0});
    return;
  }
  const Zero zero = step.turn(Readings::rate, before, turns, twice ? step.beside_start() : 0);
  const bool is_here = zero.state == Zero::State::found &&
                       zero.s <= step.tolerances.just_passed * step.stepper.step().distance;
  if (!(is_here && (twice || has_turned(step)))) step.note(folds, PointType::fold, 0, zero);
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
