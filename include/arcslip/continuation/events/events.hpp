#pragma once

// What may happen within a step: a fold, an extremum of a tracked observable, a branch point, a pair of
// eigenvalues on the imaginary axis, a zero of a test or of a user's function, the end of the regime. Each is
// a zero of a function along the branch and is solved for on the branch itself, to rounding.

#include <vector>

#include "arcslip/continuation/path/watch.hpp"

namespace arcslip::continuation {

/// One of them, within the step last attempted.
struct Event {
  /// Which function vanishes; `pair` and `real` are of eigenvalues, `crossing` is a branch point.
  enum class Kind { border, fold, extremum, crossing, function, pair, real };
  Kind kind;         ///< the function's
  PointType type;    ///< of the point that is stored for it
  Index index;       ///< of the border, observable, function or eigenvalue
  double s;          ///< where in the step
  bool told = true;  ///< false if another event at the same place says what it is
  int unstable = 0;  ///< by how many eigenvalues more the branch is unstable behind it
};

/// What a search has found.
struct [[nodiscard]] EventSearch {
  bool solved = true;         ///< false if an event is there but could not be located: take a shorter step
  std::vector<Event> events;  ///< the first one in the step, and those that fall together with it
};

/// Looks through the step that `stepper` has last attempted; `signs` are those where it begins.
EventSearch find_first_events(Stepper& stepper, Watch& watch, const Signs& signs);

}  // namespace arcslip::continuation
