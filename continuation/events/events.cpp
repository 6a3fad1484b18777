#include "arcslip/continuation/events/events.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "arcslip/continuation/events/step_search.hpp"

namespace arcslip::continuation {

namespace {

/// Below which an eigenvalue is zero; all of them may vanish together.
double zero_eigenvalue(const Watch& watch, const Tolerances& tolerances) {
  const ComplexVector& values = watch.eigenvalues();
  double largest = values.size() > 0 ? values.cwiseAbs().maxCoeff() : 0;
  for (const Look& look : watch.kept()) {
    for (const double rate : look.rates) largest = std::max(largest, std::abs(rate));
  }
  return tolerances.zero_eigenvalue * largest;
}

}  // namespace

int Passage::real_crossings() const {
  if (before.unstable < 0) return 0;
  const ComplexVector& values = watch.eigenvalues();
  const double zero = zero_eigenvalue(watch, stepper.tolerances());
  int more = 0;
  for (Index i = 0; i < values.size(); ++i) {
    if (std::abs(values(i)) <= zero) more += i < before.unstable ? -1 : 1;
  }
  return more;
}

StepSearch::StepSearch(Stepper& stepper_, Watch& watch_, const Signs& signs_)
    : stepper(stepper_),
      watch(watch_),
      signs(signs_),
      tolerances(stepper.tolerances()),
      functions_at_end(watch.functions()),
      eigenvalues_at_end(watch.eigenvalues()),
      readings(stepper, watch, functions_at_end, eigenvalues_at_end),
      upper_(stepper.step().distance) {}

EventSearch StepSearch::run() {
  for (const EventKind* kind : event_kinds) {
    const double end = upper_;
    if (solved()) kind->search(*this);
    if (kind == &user_events && upper_ < end && solved()) search_extrema_before_corner();
  }
  note_jumps_at_folds();
  for (Event& event : result_.events) {
    const auto& types = event.kind->explained_by;
    event.told = std::none_of(types.begin(), types.end(), [this](PointType type) { return has(type); });
    if (event.told && event.type == PointType::branch_point && an_eigenvalue_vanishes())
      event.type = watch.real_crossing();
  }
  return std::move(result_);
}

/// An event of the user may lie on a corner, where a jump of the slope hides an extremum before it from the
/// signs at both ends of the step. One at the corner is told by the slopes on both sides of it.
void StepSearch::search_extrema_before_corner() {
  const double corner = upper_;
  const std::vector<Event> there = result_.events;
  for (const double end : {corner, (1 - a_little) * corner}) {  // by rounding its slope is that behind it
    upper_ = end;
    observable_extrema.search(*this);
    if (upper_ < end - tolerances.located * stepper.step().distance) return;
    upper_ = corner;
    result_.events = there;
  }
}

/// Whether one that the problem has a name for is zero at the upper end.
bool StepSearch::an_eigenvalue_vanishes() {
  if (watch.real_crossing() == PointType::regular || !stepper.prober().probe(upper_)) return false;
  watch.look(stepper.prober().probed().point);
  const ComplexVector& values = watch.eigenvalues();
  return values.size() > 0 && values.cwiseAbs().minCoeff() <= zero_eigenvalue(watch, tolerances);
}

bool StepSearch::has(PointType type) const {
  return std::any_of(result_.events.begin(), result_.events.end(),
                     [type](const Event& event) { return event.type == type; });
}

void StepSearch::note(Event event) {
  const double near = tolerances.one_place * stepper.step().distance;
  if (event.s > upper_ + near) return;
  if (event.s < upper_ - near) {
    result_.events.clear();
    upper_ = event.s;
  }
  event.s = upper_;
  result_.events.push_back(event);
}

void StepSearch::note(const EventKind& kind, PointType type, Index index, const Zero& zero) {
  if (zero.state == Zero::State::failed) fail();
  if (zero.state == Zero::State::found && solved()) note({&kind, type, index, zero.s, true, 0, zero.touches});
}

void StepSearch::note_jump(const EventKind& kind, PointType type, Index index, const Zero& zero) {
  if (zero.state == Zero::State::found) jumps_.push_back({&kind, type, index, zero.s});
}

void StepSearch::note_jumps_at_folds() {
  const double beside = 1e-5 * stepper.step().distance;
  const bool begins_on_one = sign_of_rate(stepper, stepper.parameter_slope(Hold::tangent)) == 0;
  for (const Event& jump : jumps_) {
    if ((begins_on_one && jump.s < beside) || (has(PointType::fold) && jump.s > upper_ - beside)) note(jump);
  }
}

double StepSearch::at_upper(std::size_t which, double end) {
  return is_whole() ? end : readings.value(which, upper_).value_or(0);
}

double StepSearch::beside_start() const {
  constexpr double most = 0.1;  // of the step
  const Step& step = stepper.step();
  const bool is_pitchfork = std::isinf(step.here.log_determinant) && step.parameter_rate_from() == 0;
  return is_pitchfork ? std::min(std::cbrt(stepper.tolerance()), most * upper_) : 0;
}

Zero StepSearch::turn(std::size_t which, int sign, bool changes, double from) {
  constexpr double plainly = 10;  // times what it falls by to a zero that it passes straight: its value
  bool at_cusp = false;
  if (has(PointType::cusp)) {
    const std::optional<double> here = readings.value(which, 0);
    const std::optional<Node> there = readings.node(which, upper_);
    if (!here || !there) return {Zero::State::failed};
    const double fall = -sign * there->slope;  // where it only touches zero there is none
    at_cusp = std::abs(there->value) <= tolerances.as_cusp * fall * stepper.step().distance &&
              std::abs(*here) < plainly * fall * upper_;
  }
  if (!changes && !at_cusp) return {Zero::State::absent};
  const bool at_branch_point = has(PointType::branch_point);
  const Zero zero = ZeroSearch(stepper, readings)
                        .first(which, sign, from, upper_,
                               at_cusp           ? std::numeric_limits<double>::infinity()
                               : at_branch_point ? tolerances.just_passed
                                                 : tolerances.located);
  return at_cusp && zero.state == Zero::State::absent ? Zero{Zero::State::found, upper_} : zero;
}

EventSearch find_first_events(Stepper& stepper, Watch& watch, const Signs& signs) {
  return StepSearch(stepper, watch, signs).run();
}

}  // namespace arcslip::continuation
