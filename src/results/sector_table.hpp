#pragma once

// sectors.csv: what each contact of a whole ring does at the special points of its branches.

#include <string>

#include "arcslip/cases/runs.hpp"

namespace arcslip {

/// The first line, for branches of a case with these outputs.
std::string sectors_header(const TracedBranch& traced);

/// A row for each contact of each sector at each special point; nothing of curves and of one sector.
std::string sector_rows(std::size_t number, const TracedBranch& traced);

}  // namespace arcslip
