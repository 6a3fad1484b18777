#pragma once

// All solutions of F(u, p) = 0 at fixed parameters: deflated Newton iterations, and branches that come back
// to the parameters.

#include <cstdint>
#include <vector>

#include "arcslip/continuation/path/trace.hpp"

namespace arcslip::continuation {

/// Where solutions are looked for, and for what.
struct SolveAllOptions {
  double tolerance = 1e-10;    ///< on the largest entry of F
  Vector lower;                ///< n, a box in which starts are taken beside the given guesses; empty: none
  Vector upper;                ///< n
  int starts = 100;            ///< how many are taken in the box, each in its regime
  std::uint64_t seed = 1;      ///< of the starts in the box
  bool branches = true;        ///< whether branches are traced from what is found, in each parameter
  double window = 10;          ///< how far these go to either side, in the parameter's scale
  long max_points = 1000;      ///< of each
  Tolerances tolerances = {};  ///< what is the same solution, and what lies on a border
  std::function<bool()> go_on = {};  ///< asked before each start; false ends the search
};

/// What was found, and what tells of what was not.
struct [[nodiscard]] SolutionSearch {
  std::vector<Guess> solutions;  ///< in the order found
  bool finished = true;          ///< false where `go_on` ended it
  /// Newton's iterations without deflation, from independent starts spread evenly over the box, that ended on
  /// a solution, and how many of these solutions just one of them ended on: another start ends on a solution
  /// that none of these did with a probability of about singles/runs [Good 1953].
  long runs = 0;
  long singles = 0;
  long branches = 0;  ///< that were traced and came back to the parameters or ended
};

/// All solutions at the guesses' parameters that deflated Newton iterations find [Farrell, Birkisson & Funke
/// 2015] from the guesses, from each solution found, and from points spread over the box: each start is used
/// until no further solution comes of it. From each of them the branches in all parameters on which F depends
/// are traced, and those that leave them at branch points; where they have the parameters again there is a
/// solution, and from their folds deflation starts once more; all until nothing new is found. The same for
/// the same input. A solution counts only within its regime; one beyond borders is a start in the regime
/// beyond them. All guesses must share their parameters. Throws std::invalid_argument without a guess, and
/// for a box that is none.
SolutionSearch search_solutions(const Problem& problem, const std::vector<Guess>& guesses,
                                const SolveAllOptions& options = {});

/// The solutions alone.
[[nodiscard]] std::vector<Guess> solve_all(const Problem& problem, const std::vector<Guess>& guesses,
                                           const SolveAllOptions& options = {});

/// What Brouwer's degree says of solutions inside the ellipsoid that touches the sides of a box.
struct DegreeCheck {
  int expected = 0;  ///< sum of the signs of det dF/du over all solutions in it
  int found = 0;     ///< the same over those that are known
};

/// Where F points outward at all of many points of the ellipsoid's surface, or inward at all, and all known
/// solutions are regular; none else, and none of a problem in pieces or with a sparse Jacobian.
std::optional<DegreeCheck> check_degree(const Problem& problem, const std::vector<Guess>& solutions,
                                        const Vector& lower, const Vector& upper);

}  // namespace arcslip::continuation
