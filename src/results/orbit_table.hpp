#pragma once

// orbits.csv: the orbits at the special points of branches of cycles and of boundary value problems; and
// tori.csv, those of tori.

#include <string>

#include "arcslip/cases/runs.hpp"

namespace arcslip {

/// The first line, for the orbits of a case.
std::string orbits_header(const TracedBranch& traced);

/// A row for each node of each orbit, from end to end; nothing of what has none.
std::string orbit_rows(std::size_t number, const TracedBranch& traced);

/// The same of tori.csv: a row for each place of the grid, both angles from 0 on.
std::string tori_header(const TracedBranch& traced);
std::string torus_rows(std::size_t number, const TracedBranch& traced);

}  // namespace arcslip
