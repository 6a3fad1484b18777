#pragma once

// What may happen within a step: a fold, an extremum of a tracked observable, a branch point, eigenvalues on
// the imaginary axis, a zero of a test or of a user's function, the end of the regime. Each is a zero of a
// function along the branch and is solved for on the branch itself, to rounding. Each kind has a file of its
// own, and an entry in the list of step_search.hpp.

#include <vector>

#include "arcslip/continuation/path/watch.hpp"

namespace arcslip::continuation {

struct EventKind;
class StepSearch;

/// One of them, within the step last attempted.
struct Event {
  const EventKind* kind;  ///< which function vanishes
  PointType type;         ///< of the point that is stored for it
  Index index;            ///< of the border, observable, function or eigenvalue
  double s;               ///< where in the step
  bool told = true;       ///< false if another event at the same place says what it is
  int unstable = 0;       ///< by how many eigenvalues more the branch is unstable behind it
  bool touches = false;   ///< its function keeps its sign: two eigenvalues are there at once
};

/// A branch that has come to an event, with the signs before and behind it.
struct Passage {
  const Signs& before;     ///< of all tests and eigenvalues
  Signs& behind;           ///< which the event may change
  const Stepper& stepper;  ///< stands there
  const Watch& watch;      ///< the same

  /// By how many the unstable eigenvalues are more behind a fold or a branch point: those that are zero have
  /// another sign there.
  int real_crossings() const;
};

/// What all events of one kind have in common.
struct EventKind {
  void (*search)(StepSearch& step);  ///< notes the first ones in the step
  /// Changes the signs to those behind one, of which a point is stored then, unless it is not told.
  void (*pass)(const Event& event, const Passage& passage);
  std::vector<PointType> explained_by =
      {};                    ///< points at the same place that say what one is: it is not told
  bool ends_regime = false;  ///< on the border of the event's index; no point is stored for it
};

/// What a search has found.
struct [[nodiscard]] EventSearch {
  bool solved = true;         ///< false if an event is there but could not be located: take a shorter step
  std::vector<Event> events;  ///< the first one in the step, and those that fall together with it
};

/// Looks through the step that `stepper` has last attempted; `signs` are those where it begins.
EventSearch find_first_events(Stepper& stepper, Watch& watch, const Signs& signs);

}  // namespace arcslip::continuation
