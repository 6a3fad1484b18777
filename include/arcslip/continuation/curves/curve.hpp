#pragma once

// Curves of special points in two parameters: folds, branch points, Hopf points, extrema, borders, levels.

#include <memory>
#include <string>

#include "arcslip/continuation/cycles/orbit_branch.hpp"
#include "arcslip/continuation/path/trace.hpp"
#include "arcslip/continuation/points/extended_problem.hpp"

namespace arcslip::continuation {

/// The extended problem whose solutions are special points of one kind, and one of them as a guess.
struct CurveStart {
  std::unique_ptr<ExtendedProblem> problem;  ///< keeps the base by reference
  BasePoint point;                           ///< as the branch has it, not yet located anew
};

/// The curve through a special point of a branch: of folds, branch points, Hopf points, of extrema of
/// `observable` (a peak or a trough), or of points on a border (a switch). `active` is the branch's
/// parameter. Throws std::invalid_argument for a point of another type.
CurveStart curve_through(const Problem& base, const std::string& active, const BranchPoint& point,
                         const std::string& observable = {});

/// omega^2 of the pair among these that is nearest to the imaginary axis; 0 without one.
double kappa_of(const ComplexVector& eigenvalues);

/// A value of an observable.
struct Level {
  std::string observable;  ///< by name, one with a gradient
  double value;            ///< of an angle, but for whole turns
};

/// The observable less that value, at a point; of an angle, from half a turn less to half a turn more.
double above(const Level& level, const Problem& problem, const Vector& u, const Vector& p,
             const Regime& regime);

/// An event of a branch that has that value, or of an angle one that is half a turn beside it; and whether a
/// point where it happened has the value itself. The problem is kept by reference.
UserEvent event_at(const Level& level, const Problem& problem);
bool is_at(const Level& level, const Problem& problem, const BranchPoint& event);

/// The curve through a point of a branch that has that value. It goes through the regimes.
CurveStart curve_at(const Level& level, const Problem& base, const std::string& active,
                    const BranchPoint& point);

/// Locates the special point next to `start` at its other parameters, and traces the curve through it both
/// ways while `options.parameter` stays between `from` and `to` and the active parameter within the window.
/// The points are those of the extended problem: `problem.split` turns them into points of the base. Among
/// them are the curve's turning points in `options.parameter` (`fold`, of folds isola_centre or
/// simple_bifurcation), cusps, Bogdanov-Takens, zero-Hopf and double Hopf points; `options.extrema_of` may
/// name the active parameter, for the turning points in it. A curve of Hopf points ends at a Bogdanov-Takens
/// point. Of orbits the meshes follow the curve, of as many intervals as there are: it ends as `no_value`
/// where these do not suffice, see orbit_curve.hpp.
Branch trace_curve(ExtendedProblem& problem, const BasePoint& start, const TraceOptions& options,
                   const CurveWindow& window = {}, const Observer& observer = {},
                   const OrbitOptions& orbits = {});

/// Goes on with a curve as `resume` of trace.hpp does with a branch, within the window that it had.
Branch resume(ExtendedProblem& problem, const Checkpoint& checkpoint, const TraceOptions& options,
              const Observer& observer = {}, const OrbitOptions& orbits = {});

}  // namespace arcslip::continuation
