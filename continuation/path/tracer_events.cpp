// What a branch takes from the events that a step ends at.

#include <algorithm>
#include <cmath>

#include "arcslip/continuation/path/tracer.hpp"

namespace arcslip::continuation {

void Tracer::take_events(const Signs& before) {
  const auto is_border = [](const Event& event) { return event.kind == Event::Kind::border; };
  const auto border = std::find_if(events_.begin(), events_.end(), is_border);
  state_.signs.unstable = before.unstable;
  for (const Event& event : events_) take_event(event, before);
  if (border != events_.end()) cross(static_cast<int>(border->index), on_several_borders());
  if (stopped_) return;
  if (state_.arclength > 0) take_targets_around(before.parameter * state_.signs.parameter < 0);
}

void Tracer::take_event(const Event& event, const Signs& before) {
  const auto index = static_cast<std::size_t>(event.index);
  Signs& signs = state_.signs;
  switch (event.kind) {
    case Event::Kind::fold:
      signs.parameter = -before.parameter;
      if (event.told) signs.unstable += real_crossings(before);
      break;
    case Event::Kind::extremum: signs.observables[index] = -before.observables[index]; break;
    case Event::Kind::crossing:
      signs.parameter = sign_of(stepper_.crossing()->rate_behind);
      // An eigenvalue only touches zero where the branch turns.
      if (event.told && signs.parameter == before.parameter) signs.unstable += real_crossings(before);
      break;
    case Event::Kind::function: signs.functions[index] = -before.functions[index]; break;
    case Event::Kind::pair:
    case Event::Kind::real: signs.unstable += event.unstable; break;
    case Event::Kind::border: return;
  }
  if (event.told)
    store(event.type, event.kind == Event::Kind::function ? watch_.label(index) : std::string());
}

/// By how many the unstable eigenvalues are more behind a fold or a branch point: those that are zero have
/// another sign there.
int Tracer::real_crossings(const Signs& before) const {
  const double zero = options_.tolerances.zero_eigenvalue;
  if (before.unstable < 0) return 0;
  const ComplexVector& values = watch_.eigenvalues();
  int more = 0;
  for (Index i = 0; i < values.size(); ++i) {
    if (std::abs(values(i)) <= zero * values.cwiseAbs().maxCoeff()) more += i < before.unstable ? -1 : 1;
  }
  return more;
}

}  // namespace arcslip::continuation
