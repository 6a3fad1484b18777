#pragma once

// Period doublings of cycles as an extended problem.

#include "arcslip/continuation/cycles/cycle_problem.hpp"
#include "arcslip/continuation/points/singular_problem.hpp"

namespace arcslip::continuation {

/// Cycles with a multiplier -1: the variation v' = T f_u v with v(1) = -v(0) has a solution. The singular
/// matrix is the Jacobian of the cycle without T and phase, with the sign of u(0) changed in u(1) = u(0).
class DoublingProblem : public SingularProblem {
 public:
  /// `active` becomes an unknown. The base is kept by reference.
  DoublingProblem(const CycleProblem& base, Index active);

 protected:
  void fill(BorderedSolver& solver) const override;

 private:
  Index unknowns_;  // of the field
};

}  // namespace arcslip::continuation
