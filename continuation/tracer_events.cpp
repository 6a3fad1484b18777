// Special points at the end of a step.

#include <algorithm>

#include "arcslip/continuation/tracer.hpp"

namespace arcslip::continuation {

void Tracer::take_events(const Signs& before, int sign_beyond) {
  const auto is_border = [](const Event& event) { return event.kind == Event::Kind::border; };
  const auto border = std::find_if(events_.begin(), events_.end(), is_border);
  for (const Event& event : events_) take_event(event, before, sign_beyond);
  if (border != events_.end()) cross(static_cast<int>(border->index), on_several_borders());
  if (stopped_) return;
  if (state_.arclength > 0) take_targets_around(before.parameter * state_.signs.parameter < 0);
}

void Tracer::take_event(const Event& event, const Signs& before, int sign_beyond) {
  const auto index = static_cast<std::size_t>(event.index);
  Signs& signs = state_.signs;
  switch (event.kind) {
    case Event::Kind::fold:
      signs.parameter = -before.parameter;
      count_unstable(before, false);
      break;
    case Event::Kind::extremum: signs.observables[index] = -before.observables[index]; break;
    case Event::Kind::crossing:
      signs.parameter = sign_beyond != 0 ? sign_beyond : before.parameter;
      count_unstable(before, signs.parameter != before.parameter);
      break;
    case Event::Kind::pair:
      signs.unstable = before.unstable + (event.index < before.unstable ? -2 : 2);
      break;
    case Event::Kind::function:
      signs.functions[index] = -before.functions[index];
      if (explains_fold(event.type) && sign_beyond != 0) signs.parameter = sign_beyond;
      return store(event.type, watch_.label(index));
    case Event::Kind::border: return;
  }
  store(event.type);
}

/// At a fold or a branch point one real eigenvalue vanishes. It changes sign unless the branch turns at a
/// branch point: then it only touches zero.
void Tracer::count_unstable(const Signs& before, bool turns) {
  if (before.unstable < 0) return;
  state_.signs.unstable = before.unstable;
  if (turns) return;
  Index nearest = 0;
  watch_.eigenvalues().cwiseAbs().minCoeff(&nearest);
  state_.signs.unstable += nearest < before.unstable ? -1 : 1;
}

}  // namespace arcslip::continuation
