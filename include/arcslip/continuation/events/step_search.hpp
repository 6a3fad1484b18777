#pragma once

// A step as it is searched for its first events, and all kinds of these.

#include <array>

#include "arcslip/continuation/events/events.hpp"
#include "arcslip/continuation/events/zero_search.hpp"

namespace arcslip::continuation {

/// Serves one step, that which the stepper has attempted last. Keeps references to its arguments.
class StepSearch {
 public:
  /// With the signs where the step begins.
  StepSearch(Stepper& stepper, Watch& watch, const Signs& signs);

  /// For all kinds.
  EventSearch run();

  Stepper& stepper;                      ///< that has attempted the step
  Watch& watch;                          ///< looks at places of it
  const Signs& signs;                    ///< where it begins
  const Tolerances& tolerances;          ///< the stepper's
  std::vector<double> functions_at_end;  ///< as Watch::functions
  ComplexVector eigenvalues_at_end;      ///< as Watch::eigenvalues
  Readings readings;                     ///< of the step

  /// Up to where events are looked for, and whether that is all of it.
  double upper() const { return upper_; }
  bool is_whole() const { return upper_ == stepper.step().distance; }
  double chord() const { return stepper.step().chord.norm() * upper_ / stepper.step().distance; }
  /// Whether an event is known at the upper end, beyond which others do not count.
  bool ends_at_event() const { return !result_.events.empty(); }
  bool has(PointType type) const;  ///< among the events there

  /// A reading at the upper end, of which `end` is that at the end of the whole step; 0 where it has none.
  double at_upper(std::size_t which, double end);

  /// The zero of a derivative along the branch, behind `from`. All of those that are made of parameters
  /// vanish at a cusp.
  Zero turn(std::size_t which, int sign, bool changes, double from = 0);

  /// From where the rate of a parameter is no rounding: beside a pitchfork, at which it turns, it is what the
  /// corrector leaves over the square of the way, and so up to the cube root of that.
  double beside_start() const;

  /// Keeps the events of the first place only; the others are looked for up to there.
  void note(Event event);
  /// The same of one at a zero that was looked for.
  void note(const EventKind& kind, PointType type, Index index, const Zero& zero);

  /// Keeps where a test jumps: it is an event where the parameter turns there, as a multiplier that goes from
  /// far below -1 through 1 passes -1 as well, be it nearer to the fold than can be told.
  void note_jump(const EventKind& kind, PointType type, Index index, const Zero& zero);

  /// There is an event that could not be located.
  void fail() { result_.solved = false; }
  bool solved() const { return result_.solved; }

  /// Of the way to an event that may lie on a corner: so far before it what holds there is told from what
  /// does behind it.
  static constexpr double a_little = 1e-3;

 private:
  void search_extrema_before_corner();
  void note_jumps_at_folds();
  bool an_eigenvalue_vanishes();

  double upper_;
  EventSearch result_;
  std::vector<Event> jumps_;
};

/// Each in the file of its name, but for the functions' in function_zeros.cpp.
extern const EventKind border_crossings, branch_points, test_zeros, folds, observable_extrema, user_events,
    axis_crossings;

/// In the order in which a step is searched for them. What lies beyond the end of the regime is not the
/// branch, so that all else is looked for up to there; tests tell where the derivatives along the branch
/// vanish together.
inline constexpr std::array event_kinds = {&border_crossings,   &branch_points, &test_zeros,    &folds,
                                           &observable_extrema, &user_events,   &axis_crossings};

}  // namespace arcslip::continuation
