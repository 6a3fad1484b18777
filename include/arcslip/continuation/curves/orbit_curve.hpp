#pragma once

// Curves of special points in two parameters, of orbits on meshes as fine as they ask for.

#include <functional>

#include "arcslip/continuation/curves/curve.hpp"

namespace arcslip::continuation {

/// Where one begins.
struct OrbitCurveStart {
  std::shared_ptr<const OrbitProblem> orbits;
  /// The extended problem, at orbits on any mesh.
  std::function<std::unique_ptr<ExtendedProblem>(const OrbitProblem&, const BasePoint&)> make;
  BasePoint point;   ///< a special orbit, or one that is to become one along the direction
  Vector direction;  ///< of the unknowns of the extended problem and the parameter, or empty: both ways
};

/// Through a special point of a branch of orbits, on meshes of its own: of a fold, a branch point, a period
/// doubling or a Neimark-Sacker point. Throws std::invalid_argument for a point of another type.
OrbitCurveStart orbit_curve_through(const OrbitProblem& orbits, const std::string& active,
                                    const BranchPoint& point);

/// A curve and what its points are solutions of; of orbits regimes are frames of the base.
struct Curve {
  std::shared_ptr<const Problem> base;
  std::shared_ptr<ExtendedProblem> problem;
  Branch branch;
};

/// As `trace_curve` does it. Meshes follow the orbits, and where no mesh of so many intervals is good enough
/// all is traced anew on twice as many.
Curve trace_orbit_curve(const OrbitCurveStart& start, const TraceOptions& options,
                        const CurveWindow& window = {}, const OrbitOptions& orbits = {},
                        const Observer& observer = {});

/// The curve of `curve_through`, of orbits traced so.
Curve trace_curve_through(std::shared_ptr<const Problem> base, const std::string& active,
                          const BranchPoint& point, const std::string& observable,
                          const TraceOptions& options, const CurveWindow& window = {},
                          const OrbitOptions& orbits = {}, const Observer& observer = {});

}  // namespace arcslip::continuation
