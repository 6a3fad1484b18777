// Zeros of functions without derivatives: of the problem's tests and of the user's.

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <optional>

#include "arcslip/continuation/events/remote_zero.hpp"
#include "arcslip/continuation/events/step_search.hpp"

namespace arcslip::continuation {
namespace {

/// A place of the step, and a function's value there.
struct Known {
  double s;
  double value;
};

/// At the first of these places, in parts of the way up to which events are looked for, at which a function
/// has a value with a sign.
std::optional<Known> first_known(StepSearch& step, std::size_t which, std::initializer_list<double> parts) {
  for (const double part : parts) {
    const double s = part * step.upper();
    const std::optional<double> value = step.readings.value(which, s);
    if (value && *value != 0) return Known{s, *value};
  }
  return std::nullopt;
}

/// Of a normal form of maps and cycles, whose terms may have poles at other special points: there it has
/// either sign.
bool is_coefficient(PointType type) {
  return type == PointType::generalized_period_doubling || type == PointType::chenciner;
}

constexpr double off_pole = 1e-6;  // of the step: nearer to a pole rounding has either sign

/// As far as a function is known that has a value where the step begins: to its end, or to its first event. A
/// determinant that has no value at either is rounding before; others are read a little before an event where
/// they have no value or no sign, as it may be where a curve ends, coefficients before any.
std::optional<Known> known_by(StepSearch& step, std::size_t which, double end, PointType type) {
  const bool is_determinant = type == PointType::branch_point;
  if ((step.is_whole() || is_determinant) && !std::isfinite(end)) return std::nullopt;
  if (step.is_whole()) return Known{step.upper(), end};
  if (is_coefficient(type)) return first_known(step, which, {1 - off_pole, 1 - 1e-3, 1 - 1e-2, 1 - 1e-1});
  if (!is_determinant) return first_known(step, which, {1, 1 - 1e-3, 1 - 1e-2, 1 - 1e-1});
  const std::optional<double> value = step.readings.value(which, step.upper());
  return value ? std::optional(Known{step.upper(), *value}) : std::nullopt;
}

/// A little before the event at which the step ends, if the function has its other sign there: on a corner
/// that is one of its zeros as well its sign is rounding.
std::optional<Known> other_sign_beside(StepSearch& step, std::size_t which, int before, double at_end) {
  constexpr double a_little = StepSearch::a_little;
  const double located = step.tolerances.located * step.stepper.step().distance;
  if (step.is_whole() || a_little * step.upper() <= located || before * sign_of(at_end) <= 0)
    return std::nullopt;
  const std::optional<Known> beside = first_known(step, which, {1 - a_little});
  return beside && before * sign_of(beside->value) < 0 ? beside : std::nullopt;
}

/// Of as many factors as there are multipliers, of which two may vanish at once, as symmetries have it.
bool is_product(PointType type) {
  return type == PointType::period_doubling || type == PointType::symmetry_breaking;
}

/// One at which several factors vanish at once, as it shows from afar: next to it values are rounding.
Zero multiple_zero(StepSearch& step, std::size_t which, const Zero& found) {
  constexpr double farthest = 0.05;  // of the step: from how far it is looked at
  constexpr double flat = 1e-3;      // of its steepest: a slope there that is none
  constexpr int most = 6;            // factors
  const double end = step.stepper.step().distance;
  const std::optional<Node> here = step.readings.node(which, found.s);
  const double size = std::max(std::abs(step.readings.value(which, 0).value_or(0)),
                               std::abs(step.readings.value(which, end).value_or(0)));
  if (!found.touches && !(here && std::abs(here->slope) * end < flat * size)) return found;
  const auto value_at = [&](double place) { return step.readings.value(which, place); };
  for (double radius = farthest; radius > flat; radius *= 0.5) {
    for (int multiplicity = 2; multiplicity <= most; ++multiplicity) {
      const auto zero = remote_zero(value_at, {0, end, found.s, multiplicity, 0, end}, radius * end);
      if (zero && zero->agrees) return {Zero::State::found, zero->s, multiplicity % 2 == 0};
    }
  }
  return found;
}

void search_function(StepSearch& step, const EventKind& kind, std::size_t i) {
  const auto index = static_cast<Index>(i);
  const std::size_t which = step.readings.function(index);
  const bool is_determinant = step.watch.type(i) == PointType::branch_point;
  const bool begins = std::isfinite(step.watch.kept().front().functions[i]);
  if (!begins && (is_determinant || step.watch.type(i) == PointType::event)) return;  // no zero is told
  const std::optional<Known> known = known_by(step, which, step.functions_at_end[i], step.watch.type(i));
  if (!known) return;
  const auto [to, after] = *known;
  int before = step.signs.functions[i];
  double from = 0;
  if (!begins || (step.signs.at_crossing && is_coefficient(step.watch.type(i)))) {
    const std::optional<Known> beyond = first_known(step, which, {off_pole, 1e-3, 1e-2, 1e-1});
    if (!beyond) return;
    before = sign_of(beyond->value);
    from = beyond->s;
  }
  // A determinant that is rounding as a branch begins, where symmetries are lost, tells nothing.
  if (before == 0 && is_determinant) return;
  const bool changes = before != 0 && before != sign_of(after);
  const bool may_vanish = step.watch.function_may_vanish(i, step.chord(), after);
  if (const std::optional<std::size_t> piece = step.watch.piece_of(i)) {
    ZeroSearch zeros(step.stepper, step.readings, {.jumps_count = false, .left_over = 1e-5});
    const std::size_t pieces = step.readings.function(static_cast<Index>(*piece));
    Zero zero = zeros.first_of_pieces({which, pieces}, before, may_vanish, 0, to);
    if (zero.state == Zero::State::absent) {
      if (const std::optional<Known> beside = other_sign_beside(step, which, before, after))
        zero = zeros.first_of_pieces({which, pieces}, before, false, 0, beside->s);
    }
    // Functions that vanish together but for rounding do so at the last of these places, behind which all
    // have their other sign: on a piece that lies within the step none would have it at the first.
    const double located = step.tolerances.located * step.stepper.step().distance;
    if (to - zero.s <= std::max(located, ZeroSearch::no_way)) zero.s = to;
    step.note(kind, step.watch.type(i), index, zero);
  } else if (changes || may_vanish) {
    // A determinant is found to rounding, and runs through decades.
    ZeroOptions options{.jumps_count = false, .left_over = is_determinant ? 1e-8 : ZeroOptions{}.left_over};
    if (is_product(step.watch.type(i))) options.least_touched = 0;
    ZeroSearch zeros(step.stepper, step.readings, options);
    Zero zero = zeros.first(which, before, from, to, step.tolerances.located);
    if (is_product(step.watch.type(i)) && zero.state == Zero::State::found)
      zero = multiple_zero(step, which, zero);
    step.note(kind, step.watch.type(i), index, zero);
    if (changes && zero.state == Zero::State::absent && step.watch.type(i) == PointType::period_doubling)
      step.note_jump(
          kind, step.watch.type(i), index,
          ZeroSearch(step.stepper, step.readings).first(which, before, 0, to, step.tolerances.located));
  }
}

/// Coefficients last, as far as their terms have no poles.
void search_functions(StepSearch& step, const EventKind& kind) {
  const bool of_user = &kind == &user_events;
  for (const bool coefficients : {false, true}) {
    for (std::size_t i = 0; i < step.watch.searched() && step.solved(); ++i) {
      const PointType type = step.watch.type(i);
      if ((type == PointType::event) == of_user && is_coefficient(type) == coefficients)
        search_function(step, kind, i);
    }
  }
}

void pass_zero(const Event& event, const Passage& passage) {
  const auto i = static_cast<std::size_t>(event.index);
  passage.behind.functions[i] = passage.watch.piece_of(i) ? sign_of(passage.watch.functions()[i])
                                : event.touches           ? passage.before.functions[i]
                                                          : -passage.before.functions[i];
  const bool crosses =
      event.type == PointType::branch_point || (event.type != PointType::event && !event.touches);
  if (event.told && crosses) passage.behind.unstable += passage.real_crossings();
}

}  // namespace

const EventKind test_zeros{[](StepSearch& step) { search_functions(step, test_zeros); }, pass_zero};
const EventKind user_events{[](StepSearch& step) { search_functions(step, user_events); }, pass_zero};

}  // namespace arcslip::continuation
