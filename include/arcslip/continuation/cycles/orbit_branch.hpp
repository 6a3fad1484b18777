#pragma once

// Branches of orbits, cycles and others, on meshes that follow them.

#include <functional>
#include <stdexcept>

#include "arcslip/continuation/cycles/periodic_orbit.hpp"
#include "arcslip/continuation/path/trace.hpp"

namespace arcslip::continuation {

/// On what orbits are held.
struct OrbitOptions {
  Index intervals = 20;           ///< N to begin with
  int degree = 5;                 ///< m
  bool trigonometric = false;     ///< whether cycles are trigonometric polynomials, on no intervals
  int waves = 8;                  ///< their degree H to begin with
  int most_waves = 128;           ///< as most_intervals, for one period
  double tolerance = 1e-6;        ///< on the estimated error of orbits, relative to how far their unknowns go
  Index most_intervals = 2560;    ///< a branch that asks for more has ended
  int doublings = 3;              ///< how often a period is doubled, of cascades without end
  std::size_t max_branches = 50;  ///< all of them together
  bool tori = false;              ///< whether those that leave cycles are followed as well

  /// What those of a field are held on to begin with. Throws std::invalid_argument where there is none: waves
  /// couple all places, so that nothing of a sparse field is sparse.
  OrbitMesh mesh(const Field& field) const {
    if (!trigonometric) return {rule_for(field, degree), intervals};
    if (field.sparse())
      throw std::invalid_argument("cycles of sparse systems are held on intervals, not by balance");
    return {CollocationRule::trigonometric(waves), 1};
  }
};

using CycleOptions = OrbitOptions;

/// The same for those that keep as many intervals, or waves, as there are.
inline OrbitOptions with_these_intervals(OrbitOptions orbits = {}) {
  orbits.most_intervals = 0;
  orbits.most_waves = 0;
  return orbits;
}

/// An orbit to set out from: the guess is one of the problem's.
struct OrbitStart {
  std::shared_ptr<const OrbitProblem> problem;
  Guess guess;
  bool both_ways = false;  ///< along a direction and against it, or to both ends of the range
};

/// The problem with one of its solutions for its only frame.
inline std::shared_ptr<OrbitProblem> about(const OrbitProblem& problem, const Vector& u, const Vector& p,
                                           const Regime& regime) {
  return problem.about(problem.frame(regime).mesh, problem.orbit(u), p);
}

/// One close to an orbit: as its values at the nodes of the problem's first frame tell.
OrbitStart start_from(std::shared_ptr<const OrbitProblem> problem, const Matrix& orbit, double duration,
                      const Vector& p);

/// The other branch through a branch point; none where it is not found.
std::optional<OrbitStart> orbit_from_branch_point(const OrbitProblem& problem, const std::string& parameter,
                                                  const BranchPoint& point,
                                                  const Tolerances& tolerances = {});

/// How far the first orbit of a branch is from what it leaves, of the scale.
inline constexpr double first_departure = 1e-3;

/// The orbits of twice the period that leave a period doubling, from one that is so far from two rounds of
/// the single one; none where the doubling is not located.
std::optional<OrbitStart> orbit_from_doubling(const PeriodicOrbit& problem, Index parameter,
                                              const BranchPoint& doubling, double far = first_departure);

/// The same start on a mesh of this resolution, or on one that is made for its orbit, which comes as values
/// on the mesh before.
OrbitStart refined(const OrbitStart& start, Index resolution);
OrbitStart refined(const OrbitStart& start, const std::function<OrbitMesh(const Matrix&)>& mesh_for);

/// A branch and what its points are solutions of: their regimes are this problem's frames.
struct OrbitBranch {
  std::shared_ptr<const OrbitProblem> problem;
  Branch branch;
};

/// As `trace` does it, from a guess with a direction along it, or along it and against it; else from its
/// parameter towards `to`, or both ways.
OrbitBranch trace_orbits(const OrbitStart& start, const TraceOptions& options,
                         const OrbitOptions& orbits = {}, const Observer& observer = {});

/// A branch and all that can be reached from it through branch points and, of periodic ones, period
/// doublings, each once.
std::vector<OrbitBranch> trace_connected_orbits(const OrbitStart& start, const TraceOptions& options,
                                                const OrbitOptions& orbits = {},
                                                const Observer& observer = {});

}  // namespace arcslip::continuation
