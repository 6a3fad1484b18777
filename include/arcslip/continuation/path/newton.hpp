#pragma once

// Solutions of F(u, p) = 0 at fixed parameters: Newton's method, and all solutions by deflation.

#include <cstdint>
#include <vector>

#include "arcslip/continuation/path/corrector.hpp"
#include "arcslip/continuation/path/trace.hpp"

namespace arcslip::continuation {

/// Where Newton's method ended.
struct [[nodiscard]] Solution {
  Correction outcome = Correction::cannot_evaluate;  ///< the rest counts only where this is `converged`
  Vector unknowns;                                   ///< n
  double residual = 0;                               ///< largest entry of F
  int iterations = 0;                                ///< taken
};

/// What ends the iteration.
struct NewtonOptions {
  double tolerance = 1e-10;   ///< on the largest entry of F; iterations go on to rounding
  int max_iterations = 30;    ///< before it is given up
  double max_correction = 0;  ///< longest correction in the problem's scale, 0 for no limit
};

/// Newton's method from a guess, with the full exact Jacobian.
Solution solve(const Problem& problem, const Guess& guess, const NewtonOptions& options = {});

/// Where `solve_all` looks, and for what.
struct SolveAllOptions {
  double tolerance = 1e-10;    ///< on the largest entry of F
  Vector lower;                ///< n, a box in which starts are taken beside the given guesses; empty: none
  Vector upper;                ///< n
  int starts = 100;            ///< how many are taken in the box, each in its regime
  std::uint64_t seed = 1;      ///< of the starts in the box
  Tolerances tolerances = {};  ///< what is the same solution, and what lies on a border
  std::function<bool()> go_on = {};  ///< asked before each start; false ends the search
};

/// All solutions at the guesses' parameters that deflated Newton finds [Farrell, Birkisson & Funke 2015] from
/// the guesses, from each solution found, and from points spread over the box: each start is used until no
/// further solution comes of it. In the order found; the same for the same input. A solution counts only
/// within its regime; one beyond borders is a start in the regime beyond them. All guesses must share their
/// parameters.
[[nodiscard]] std::vector<Guess> solve_all(const Problem& problem, const std::vector<Guess>& guesses,
                                           const SolveAllOptions& options = {});

}  // namespace arcslip::continuation
