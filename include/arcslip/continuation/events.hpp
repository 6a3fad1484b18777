#pragma once

// What may happen within a step: a fold, an extremum of a tracked observable, the end of the regime. Each is
// a zero of a function along the branch and is solved for on the branch itself, to rounding.

#include <optional>
#include <vector>

#include "arcslip/continuation/stepper.hpp"

namespace arcslip::continuation {

/// Signs of the derivatives along the branch as last seen, 0 where one has vanished; an event changes a sign.
/// They are remembered, not computed again, since just behind an extremum the sign is noise.
struct Signs {
  int parameter = 0;
  std::vector<int> observables;

  /// The signs at the start of a piece.
  void reset(const std::vector<Monitor>& monitors, Index tracked, double parameter_rate);

  /// Takes over the signs at the end of a step.
  void update(const std::vector<Monitor>& monitors, double parameter_rate);
};

/// Sign of a derivative, 0 below rounding of the value it belongs to.
int sign_of_slope(const Monitor& monitor);

struct Event {
  enum class Kind { fold, extremum, crossing };
  Kind kind;
  Index index;  ///< of the tracked observable or of the border
  double s;     ///< where in the step
};

struct EventSearch {
  bool solved = true;          ///< false if an event is there but could not be located: take a shorter step
  std::optional<Event> first;  ///< the first one in the step
};

EventSearch find_first_event(Stepper& stepper, const Signs& signs);

}  // namespace arcslip::continuation
