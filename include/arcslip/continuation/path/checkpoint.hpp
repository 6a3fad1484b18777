#pragma once

// All that a branch under way consists of, so that it can be taken up again and goes on bit by bit as if it
// had never been left.

#include <array>
#include <iosfwd>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "arcslip/continuation/path/corrector.hpp"
#include "arcslip/continuation/path/stop.hpp"
#include "arcslip/continuation/problem/guess.hpp"

namespace arcslip::continuation {

/// What the correction of a step keeps: its length along the tangent, or the parameter.
enum class Hold { tangent, parameter };

/// Value of a function along the branch and its derivative in the step's coordinate s = normal . (z -
/// z_here)/scale.
struct Monitor {
  double value = 0;  ///< of the function
  double slope = 0;  ///< by s
  double reach = 0;  ///< by how much it changes with all that it depends on, by the scale of each; not kept
  Index piece = 0;   ///< as Gradient has it; not kept
};

/// What changes its sign at branch points and at folds, at an earlier point.
struct PastPoint {
  double behind = 0;  ///< its distance
  double sign = 0;    ///< of the determinant
  double log = 0;     ///< of the determinant's size
  double rate = 0;    ///< of the parameter over arclength
};

/// What a branch is watched by, at this point or at an earlier one.
struct Look {
  double behind = 0;              ///< its distance
  std::vector<double> functions;  ///< tests of the problem, then the user's events
  std::vector<double> rates;      ///< real parts of the eigenvalues, descending
  std::vector<double> turns;      ///< imaginary parts of the same
};

constexpr std::size_t most_past = 3;  ///< points before this one that are remembered

/// Signs along the branch as last seen, 0 where a function has just vanished; an event changes a sign. They
/// are remembered, not computed again, since just behind a zero the sign is noise.
struct Signs {
  int parameter = 0;             ///< of its change along the branch
  std::vector<int> observables;  ///< of the derivatives of those tracked
  std::vector<double> since;     ///< each of these turned last: the arclength; infinite on another piece
  std::vector<int> functions;    ///< of the tests of the problem, then of the user's events
  int unstable = -1;             ///< eigenvalues with a positive real part; -1 without eigenvalues
  bool at_crossing = false;      ///< here some of them were told to vanish
};

/// How a branch goes on, as far as the last steps tell.
struct Bends {
  std::array<Vector, 3> derivatives;  ///< d^2 z/ds^2, d^3 z/ds^3 and d^4 z/ds^4 over the arc; 0: not known
  double length = 0;                  ///< of the last step along the arc, in whose middle the first one is
};

/// One way along a branch, as far as it was gone.
struct Progress {
  CurvePoint here;                    ///< the last one stored
  Bends bends;                        ///< in the scale here
  std::vector<Monitor> monitors;      ///< of the tracked observables, then of the borders
  Signs signs;                        ///< here
  Hold hold = Hold::tangent;          ///< of the next step
  double distance = 0;                ///< of the next step
  double arclength = 0;               ///< from the start to here
  CurvePoint start;                   ///< which a closed loop comes back to
  std::map<std::string, long> found;  ///< special points so far, by type
  /// Arclength of the last fold, NaN before the first, and the way to it from the one before, 0 without one.
  double fold = std::numeric_limits<double>::quiet_NaN();
  double winding = 0;
  double last_value = 0;        ///< of the parameter, where the last step began
  double last_chord = 0;        ///< of the last step
  std::vector<double> taken;    ///< values of the parameter that have their point here
  double residual_size = 0;     ///< what the tolerance on F is relative to; 0: to be found again
  std::vector<double> borders;  ///< of an extended problem: those of its conditions
  std::vector<PastPoint> past;  ///< the last one first
  std::vector<Look> looks;      ///< the one here, then earlier ones
  int rescaled = 0;             ///< 1 where the problem has been scaled anew here
};

/// What a branch is one of; whatever goes on with it must be the same.
struct BranchIdentity {
  std::vector<std::string> parameters;  ///< the problem's
  std::vector<std::string> regimes;     ///< names of those in which at most one switch is not in state 0
  std::vector<std::string> tests;       ///< types of the points that the problem looks for
  std::string parameter;                ///< the one that is continued
  std::vector<std::string> extrema_of;  ///< names of the observables that are tracked
  std::vector<std::string> events;      ///< the user's, by name

  /// Whether both are of one branch.
  bool operator==(const BranchIdentity&) const = default;
};

/// Where a curve of special points ends, beside the range of its parameter.
struct CurveWindow {
  double low = -std::numeric_limits<double>::infinity();  ///< of the base's active parameter
  double high = std::numeric_limits<double>::infinity();  ///< the same
};

/// A branch that was left. Of one that is traced both ways either part may have further to go.
struct Checkpoint {
  std::optional<BranchIdentity> of;   ///< none in texts of version 0.4 and before
  std::optional<CurveWindow> window;  ///< of a curve of special points, and only there
  std::optional<Progress> ahead;      ///< of the part behind the start, which is traced first
  Stop stop_ahead = Stop::no_start;   ///< why this part ended, where it has no further to go
  std::optional<Progress> back;       ///< of the part before the start
  std::optional<Guess> begin_back;    ///< or where this part is still to begin
};

/// As text, numbers in hexadecimal, so that nothing is lost.
void write(std::ostream& out, const Checkpoint& checkpoint);

/// Reads also what earlier versions have written. Throws std::runtime_error where the text is no checkpoint.
Checkpoint read_checkpoint(std::istream& in);

}  // namespace arcslip::continuation
