#pragma once

// Branches of tori, on grids that are fine enough.

#include "arcslip/continuation/cycles/cycle_branch.hpp"
#include "arcslip/continuation/cycles/torus.hpp"

namespace arcslip::continuation {

/// A branch and what its points are solutions of.
struct TorusBranch {
  std::shared_ptr<const Torus> problem;
  Branch branch;
};

/// The tori that leave a cycle at a Neimark-Sacker point, with as many waves as their tails ask for, at the
/// options' tolerance. The branch ends where they shrink onto a cycle again, and where more waves would be
/// needed than there may be. None without a pair of multipliers.
std::optional<TorusBranch> trace_torus(const CycleProblem& cycles, const BranchPoint& leaving,
                                       const TraceOptions& options, const OrbitOptions& orbits = {},
                                       const Observer& observer = {});

/// Those of all such points, each branch once.
std::vector<TorusBranch> trace_tori_leaving(const std::vector<CycleBranch>& cycles,
                                            const TraceOptions& options, const OrbitOptions& orbits = {},
                                            const Observer& observer = {});

}  // namespace arcslip::continuation
