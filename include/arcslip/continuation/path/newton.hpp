#pragma once

// A solution of F(u, p) = 0 at fixed parameters.

#include <functional>

#include "arcslip/continuation/path/corrector.hpp"
#include "arcslip/continuation/path/trace.hpp"

namespace arcslip::continuation {

/// Where Newton's method ended.
struct [[nodiscard]] Solution {
  Correction outcome = Correction::cannot_evaluate;  ///< the rest counts only where this is `converged`
  Vector unknowns;                                   ///< n
  double residual = 0;                               ///< largest entry of F
  double correction = 0;                             ///< the last one, in the problem's scale
  int iterations = 0;                                ///< taken
};

/// What ends the iteration.
struct NewtonOptions {
  double tolerance = 1e-10;   ///< on the largest entry of F; iterations go on to rounding
  int max_iterations = 30;    ///< before it is given up
  double max_correction = 0;  ///< longest correction in the problem's scale, 0 for no limit
  /// Whether a correction is halved until the next one, by the same Jacobian, is shorter than it, which leads
  /// from farther off [P. Deuflhard, Newton methods for nonlinear problems, Springer 2004, 3.3].
  bool damped = false;
  std::function<void()> watch = {};  ///< called before each correction; what it throws ends the work
};

/// Whether a guess solves F = 0 but for what the root of rounding leaves.
bool nearly_solves(const Problem& problem, const Guess& guess);

/// Newton's method from a guess, with the full exact Jacobian.
Solution solve(const Problem& problem, const Guess& guess, const NewtonOptions& options = {});

}  // namespace arcslip::continuation
