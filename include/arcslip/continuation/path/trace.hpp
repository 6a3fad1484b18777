#pragma once

// Pseudo-arclength continuation of F(u, p) = 0 in one parameter, through regimes with located borders.

#include <chrono>
#include <functional>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "arcslip/continuation/path/branch.hpp"
#include "arcslip/continuation/path/tolerances.hpp"
#include "arcslip/continuation/problem/guess.hpp"
#include "arcslip/continuation/problem/problem.hpp"

namespace arcslip::continuation {

/// A stored point as a guess, to restart from: `forward` goes on as the branch did.
Guess restart(const BranchPoint& point, bool forward = true);

/// A function whose zeros along the branch become `event` points.
struct UserEvent {
  std::string name;  ///< the label of its points
  /// must be continuous along the branch
  std::function<double(const Vector& u, const Vector& p, const Regime& regime)> function;
  /// Which of its pieces, between which it may jump, the function is on, as a number: where these follow upon
  /// each other zeros are looked for in each, by signs; none of one that is smooth. A zero of pieces is taken
  /// for a corner of the branch.
  std::function<double(const Vector& u, const Vector& p, const Regime& regime)> piece = {};
};

/// Ends the branch at the count-th special point of a type; of an `event`, of those with this label.
struct StopAfter {
  PointType type;     ///< of the points that are counted
  long count = 1;     ///< the one that ends the branch
  std::string label;  ///< of events; else empty
};

class Journal;

/// What is traced, what is looked for, and when it is enough. Only `parameter`, `from` and `to` have to be
/// set.
struct TraceOptions {
  std::string parameter;                ///< the continuation parameter, by name
  double from = 0;                      ///< its first value; the guess's is replaced by it
  double to = 1;                        ///< its last value, on which the branch ends exactly
  std::vector<double> stop_at;          ///< values to put a `user` point on, in any order
  std::vector<std::string> extrema_of;  ///< observables whose extrema become `peak` and `trough` points
  bool rough_extrema = false;     ///< whether these lie where the slopes at both ends of a step tell alone
  std::vector<UserEvent> events;  ///< user's functions whose zeros become `event` points
  std::vector<StopAfter> stop_after;  ///< the first of these to be met ends the branch
  /// Whether two branch points within one step are looked for, where the Jacobian's determinant leaves room.
  /// By default they are, but with several switches and more than 24 unknowns: there the determinant jumps
  /// and changes so fast that nearly every step leaves room. A problem that is known to have none is traced
  /// faster without.
  std::optional<bool> branch_point_pairs;
  /// Whether, at a corner within its regime that no step can pass, the branch is looked for where it goes
  /// back.
  bool turns_at_corners = true;
  /// On the largest entry of F and on the correction that is left, in the problem's scale. Of a problem whose
  /// F is in units in which its terms are above 1e3, relative to these.
  double tolerance = 1e-10;
  double max_step = 0.1;     ///< largest step, in scaled arclength
  double min_step = 1e-10;   ///< smallest step; a branch that asks for less has ended
  long max_points = 100000;  ///< to be stored; each takes 16 n bytes, 1.6 MB of 10^5 unknowns
  /// Of those followed from one to the next, all together: the last one's warning says if there are more.
  std::size_t max_branches = 50;
  /// Wall clock, of all parts of a branch together, the search for its first point included.
  double max_seconds = std::numeric_limits<double>::infinity();
  /// Symmetries of the problem: where the branch has one again that it had lost, and turns into its own image
  /// under it, it ends. Searches that follow branches to others give all.
  std::vector<Symmetry> symmetries = {};
  double bound = 1e12;  ///< largest |unknown|, in the scale at the start, before the branch is given up
  /// Asked before each evaluation of F; false ends the branch as `interrupted`.
  std::function<bool()> go_on = {};
  Tolerances tolerances = {};
  /// Where the branches are kept, to be had again by the same work done anew; null: nowhere.
  Journal* journal = nullptr;
};

/// The same for a branch of its own: without what is watched on this one, extrema, events and their counts,
/// and without its journal.
TraceOptions unwatched(TraceOptions options);

/// Thrown where a search ended before it had found what it looked for, for want of time or by an interrupt.
class Unfinished : public std::runtime_error {
 public:
  /// `explanation` is what the exception says.
  Unfinished(Stop reason, const std::string& explanation) : std::runtime_error(explanation), stop(reason) {}
  Stop stop;  ///< time_limit or interrupted
};

/// The time that several branches may take together, from now on.
class TimeBudget {
 public:
  /// Of `max_seconds`, which begin now.
  explicit TimeBudget(const TraceOptions& options) : options_(options) {}

  /// The options with the time that is left.
  TraceOptions rest() const;
  /// Whether no time is left.
  bool is_spent() const { return !(seconds_left() > 0); }
  /// Whether there is time left and go_on of the options, if there is one, says so.
  bool goes_on() const { return !is_spent() && (!options_.go_on || options_.go_on()); }

 private:
  double seconds_left() const;

  TraceOptions options_;
  std::chrono::steady_clock::time_point begun_ = std::chrono::steady_clock::now();
};

/// Called at each point stored; false ends the branch as `interrupted`.
using Observer = std::function<bool(const BranchPoint&)>;

/// Goes on with a branch that was interrupted and holds its checkpoint; gives the whole branch, as if it had
/// never been left. Throws std::invalid_argument where it is another problem's.
Branch go_on_with(const Problem& problem, Branch begun, const TraceOptions& options,
                  const Observer& observer = {});

/// Traces the branch from `options.from` to `options.to`, or from a guess with a direction until it reaches
/// one of the two. A branch that cannot be traced to its end holds what was traced and says why. Throws
/// std::invalid_argument for options that do not fit the problem.
Branch trace(const Problem& problem, const Guess& guess, const TraceOptions& options,
             const Observer& observer = {});

/// Traces one way from a guess that may lie anywhere between `from` and `to`, setting out towards `to` or
/// towards `from`; a guess with a direction goes along it or against it.
Branch trace_one_way(const Problem& problem, const Guess& guess, bool towards_to, const TraceOptions& options,
                     const Observer& observer = {});

/// Both ways: the part that sets out towards `from` comes first, reversed, with negative arclength. A closed
/// loop is traced once.
Branch trace_both(const Problem& problem, const Guess& guess, const TraceOptions& options,
                  const Observer& observer = {});

/// Two parts from one start as one branch, the first reversed.
Branch join(Branch first, Branch second);

/// A branch of two parts, `ahead` of the start and `back` from it, which begins with `guess`.
Branch trace_parts(const std::function<Branch()>& ahead, const std::function<Branch()>& back,
                   const Guess& guess);

/// What is left of such a branch: `go_on` goes on with a part, `begin_back` begins the one back.
Branch resume_parts(const Checkpoint& checkpoint, const std::function<Branch(const Progress&)>& go_on,
                    const std::function<Branch(const Guess&)>& begin_back);

/// Goes on from a checkpoint as if the branch had never been left; the points are those that were to follow:
/// of a branch traced both ways those at either end, of which those with negative arclength belong before the
/// points that there were. Throws std::invalid_argument that names what differs where problem and options are
/// not those of the checkpoint. Range, limits and tolerances may differ.
Branch resume(const Problem& problem, const Checkpoint& checkpoint, const TraceOptions& options,
              const Observer& observer = {});

}  // namespace arcslip::continuation
