#pragma once

// orbits.csv: the orbits at the special points of branches of cycles and of boundary value problems.

#include <string>

#include "arcslip/cases/runs.hpp"

namespace arcslip {

/// The first line, for the orbits of a case.
std::string orbits_header(const TracedBranch& traced);

/// A row for each node of each orbit, from end to end; nothing of what has none.
std::string orbit_rows(std::size_t number, const TracedBranch& traced);

}  // namespace arcslip
