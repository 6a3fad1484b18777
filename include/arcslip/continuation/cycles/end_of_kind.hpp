#pragma once

// Where orbits become simpler ones, branches and curves of them end: cycles shrink onto equilibria, both
// rounds of doubled ones come to be one.

#include "arcslip/continuation/cycles/orbit_problem.hpp"
#include "arcslip/continuation/path/trace.hpp"

namespace arcslip::continuation {

/// Ends branches of these orbits by an event, or curves of them, whose first unknowns are the orbits': as far
/// `apart` as `begins` they begin. Those of folds may end earlier.
void end_with_kind(const OrbitProblem& orbits, TraceOptions& options, double begins = 1,
                   bool of_folds = false);

/// Says so of a branch of `traced`, or of a curve, that has ended for it: whether it has.
bool tell_end_of_kind(const OrbitProblem& orbits, const Problem& traced, const std::string& parameter,
                      Branch& branch);

}  // namespace arcslip::continuation
