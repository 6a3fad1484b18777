// Zeros of functions without derivatives: of the problem's tests and of the user's.

#include <cmath>
#include <optional>

#include "arcslip/continuation/events/step_search.hpp"

namespace arcslip::continuation {
namespace {

/// A place of the step, and a function's value there.
struct Known {
  double s;
  double value;
};

/// As far as a function is known that has a value where the step begins: to its end, or to its first event. A
/// determinant that has no value at either is rounding before; others are read a little before an event where
/// they have no value or no sign, as it may be where a curve ends or where their terms have poles.
std::optional<Known> known_by(StepSearch& step, std::size_t which, double end, bool is_determinant) {
  if ((step.is_whole() || is_determinant) && !std::isfinite(end)) return std::nullopt;
  if (step.is_whole()) return Known{step.upper(), end};
  for (const double left : {0.0, 1e-3, 1e-2, 1e-1}) {
    const double s = (1 - left) * step.upper();
    const std::optional<double> value = step.readings.value(which, s);
    if (value && (*value != 0 || is_determinant)) return Known{s, *value};
    if (is_determinant) break;
  }
  return std::nullopt;
}

void search_function(StepSearch& step, const EventKind& kind, std::size_t i) {
  const auto index = static_cast<Index>(i);
  const std::size_t which = step.readings.function(index);
  if (!std::isfinite(step.watch.kept().front().functions[i])) return;  // no zero is told
  const bool is_determinant = step.watch.type(i) == PointType::branch_point;
  const std::optional<Known> known = known_by(step, which, step.functions_at_end[i], is_determinant);
  if (!known) return;
  const auto [to, after] = *known;
  const int before = step.signs.functions[i];
  // A determinant that is rounding as a branch begins, where symmetries are lost, tells nothing.
  if (before == 0 && is_determinant) return;
  const bool changes = before != 0 && before != sign_of(after);
  const bool may_vanish = step.watch.function_may_vanish(i, step.chord(), after);
  if (const std::optional<std::size_t> piece = step.watch.piece_of(i)) {
    ZeroSearch zeros(step.stepper, step.readings, {.jumps_count = false, .left_over = 1e-5});
    const std::size_t pieces = step.readings.function(static_cast<Index>(*piece));
    step.note(kind, step.watch.type(i), index,
              zeros.first_of_pieces({which, pieces}, before, may_vanish, 0, to));
  } else if (changes || may_vanish) {
    // A determinant is found to rounding, and runs through decades.
    ZeroSearch zeros(step.stepper, step.readings,
                     {.jumps_count = false, .left_over = is_determinant ? 1e-8 : ZeroOptions{}.left_over});
    const Zero zero = zeros.first(which, before, 0, to, step.tolerances.located);
    step.note(kind, step.watch.type(i), index, zero);
    if (changes && zero.state == Zero::State::absent && step.watch.type(i) == PointType::period_doubling)
      step.note_jump(
          kind, step.watch.type(i), index,
          ZeroSearch(step.stepper, step.readings).first(which, before, 0, to, step.tolerances.located));
  }
}

void search_functions(StepSearch& step, const EventKind& kind) {
  const bool of_user = &kind == &user_events;
  for (std::size_t i = 0; i < step.watch.searched() && step.solved(); ++i)
    if ((step.watch.type(i) == PointType::event) == of_user) search_function(step, kind, i);
}

void pass_zero(const Event& event, const Passage& passage) {
  const auto i = static_cast<std::size_t>(event.index);
  passage.behind.functions[i] =
      passage.watch.piece_of(i) ? sign_of(passage.watch.functions()[i]) : -passage.before.functions[i];
  if (event.told && event.type == PointType::branch_point)
    passage.behind.unstable += passage.real_crossings();
}

}  // namespace

const EventKind test_zeros{[](StepSearch& step) { search_functions(step, test_zeros); }, pass_zero};
const EventKind user_events{[](StepSearch& step) { search_functions(step, user_events); }, pass_zero};

}  // namespace arcslip::continuation
