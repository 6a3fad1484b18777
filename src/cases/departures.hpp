#pragma once

// Branches that leave a forced response where its half periods come to differ, or its period doubles: the
// harmonics in which they lie are none of its own, so that it has no branch point there, but is one in a
// balance that holds them as well. And modulated waves, which leave where a pair of its exponents crosses.

#include <vector>

#include "arcslip/cases/runs.hpp"

namespace arcslip {

/// Those that leave traced branches that know their stability, then those that leave these, up to responses
/// over four periods of the load; each has a request of its own with the harmonics that it lies in. Of two
/// that are images of each other, half a period or one later, one is traced. Where a symmetry breaks from
/// node to node none is found. Then the modulated waves that leave any of these. Throws nothing but what
/// tracing does.
std::vector<TracedBranch> trace_departures(const std::vector<TracedBranch>& traced,
                                           const continuation::TimeBudget& time,
                                           const continuation::Observer& observer);

}  // namespace arcslip
