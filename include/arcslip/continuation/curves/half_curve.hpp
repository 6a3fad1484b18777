#pragma once

// One way along a curve of special points.

#include <functional>
#include <string>

#include "arcslip/continuation/cycles/orbit_branch.hpp"
#include "arcslip/continuation/path/trace.hpp"
#include "arcslip/continuation/points/extended_problem.hpp"

namespace arcslip::continuation {

/// The label of the event by which a curve leaves its window.
inline const std::string end_of_window = "the window's end";

/// Options with the events that end a curve whose base has n unknowns: at the window's ends of the active
/// parameter, which is unknown n.
TraceOptions within_window(const TraceOptions& options, const CurveWindow& window, Index n);

/// Part of a curve, which `trace` traces with these options and an observer: the borders of its conditions
/// follow it, and so do meshes of orbits. One that ends on an end of its window has reached its end. Throws
/// TooCoarse where orbits need more intervals and may have them.
Branch follow_curve(ExtendedProblem& problem, const TraceOptions& options, const OrbitOptions& orbits,
                    const Observer& observer,
                    const std::function<Branch(const TraceOptions& own, const Observer& follow)>& trace);

/// Part of a curve as `trace_one_way` and `follow_curve` trace it from where the problem has been adapted to;
/// begun, or gone on with, as the options' journal knows it, if there is one, which orbits are not in: it has
/// no meshes. `again` sees the points that the journal knows, `ended` the part before the journal has it. The
/// problem is left as at the part's end.
Branch trace_part(ExtendedProblem& problem, const Guess& start, bool towards_to, const TraceOptions& options,
                  const Observer& observer, const std::function<void(Branch&)>& ended,
                  const std::function<void(const BranchPoint&)>& again, const OrbitOptions& orbits);

/// Of two reasons why the halves of a curve ended, the one that a user has to know is the curve's.
Branch most_telling(Branch curve);

}  // namespace arcslip::continuation
