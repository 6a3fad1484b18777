#pragma once

// Branches of cycles, on meshes that follow them.

#include "arcslip/continuation/cycles/cycle_problem.hpp"
#include "arcslip/continuation/cycles/orbit_branch.hpp"

namespace arcslip::continuation {

/// A cycle to set out from: the guess is one of the problem's.
struct CycleStart {
  std::shared_ptr<CycleProblem> problem;
  Guess guess;
  bool both_ways = false;  ///< along a direction and against it, or to both ends of the range
};

/// The cycles that leave a Hopf point of the field's equilibria: those of the pair of eigenvalues that is
/// nearest to the imaginary axis, then of others that are on it as well.  Throws std::invalid_argument where
/// no pair is complex.
std::vector<CycleStart> cycles_from_hopf(const std::shared_ptr<const Field>& field, const Guess& hopf,
                                         const CycleOptions& options = {});

/// A cycle beside an equilibrium: it moves by w q and its conjugate, q an eigenvector of length 1.
struct SmallCycle {
  CycleStart start;
  double size;  ///< |w|
};

/// The one that leaves an equilibrium with the pair of eigenvalues nearest to +-j omega, of this size unless
/// that is large.
SmallCycle cycle_of_pair(const std::shared_ptr<const Field>& field, const Guess& hopf, double omega,
                         const std::optional<double>& size, const CycleOptions& options = {});

/// A cycle close to an orbit: as its values at nodes tell, ends equal, over a time T.
CycleStart cycle_from_orbit(std::shared_ptr<const Field> field, const OrbitMesh& mesh, const Matrix& orbit,
                            double duration, const Vector& p, int periods = 1);

/// A branch and what its points are solutions of: their regimes are this problem's frames.
struct CycleBranch {
  std::shared_ptr<const CycleProblem> problem;
  Branch branch;
};

/// That of orbits which are cycles.
CycleBranch cycle_branch(OrbitBranch branch);

/// As `trace_orbits` does it.
CycleBranch trace_cycles(const CycleStart& start, const TraceOptions& options,
                         const CycleOptions& cycles = {}, const Observer& observer = {});

/// As `trace_connected_orbits` does it.
std::vector<CycleBranch> trace_connected_cycles(const CycleStart& start, const TraceOptions& options,
                                                const CycleOptions& cycles = {},
                                                const Observer& observer = {});

/// The cycles that leave the Hopf points of branches of equilibria and, with `follow`, all that can be
/// reached from these through branch points and period doublings, each branch once.
std::vector<CycleBranch> trace_cycles_leaving(const std::shared_ptr<const Field>& field,
                                              const std::vector<Branch>& equilibria,
                                              const TraceOptions& options, const CycleOptions& cycles = {},
                                              const Observer& observer = {}, bool follow = true);

}  // namespace arcslip::continuation
