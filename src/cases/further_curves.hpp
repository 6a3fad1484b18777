#pragma once

// Curves of special points that begin on others, or meet them.

#include <functional>
#include <memory>

#include "arcslip/cases/runs.hpp"
#include "arcslip/continuation/curves/orbit_curve.hpp"

namespace arcslip {

/// Whether two vectors are one but for how well points are located.
inline bool same_place(const Vector& a, const Vector& b) {
  return ((a - b).array().abs() <= 1e-6 * (1 + b.array().abs())).all();
}

/// What `trace` traces, with the time that it takes: a curve of what was built, or of orbits on meshes of
/// their own.
TracedBranch traced_curve(const std::shared_ptr<const CaseBranch>& request, const Built& base,
                          const std::function<continuation::Curve()>& trace);

/// A curve that is there to be traced.
struct FurtherCurve {
  Vector parameters;  ///< where it begins, all of the base's
  bool is_of_cycles;
  /// Whether a curve that was traced passes its beginning.
  std::function<bool(const TracedBranch&)> is_part_of;
  std::function<TracedBranch(const continuation::TraceOptions&, const continuation::Observer&)> trace;
};

/// Those at a point of a curve: of the same equilibria or points of a map, or of cycles.
std::vector<FurtherCurve> further_curves(const TracedBranch& curve, const continuation::BranchPoint& point,
                                         const continuation::CurveWindow& window);

/// Adds all that can be reached from these, each once: those of cycles after the others.
void follow_curves(continuation::TraceOptions options, const continuation::CurveWindow& window,
                   const continuation::TimeBudget& time, const continuation::Observer& observer,
                   std::vector<TracedBranch>& curves);

}  // namespace arcslip
