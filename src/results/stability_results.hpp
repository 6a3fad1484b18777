#pragma once

// What is told of a forced response's stability besides its columns.

#include <optional>
#include <string>

#include "arcslip/cases/runs.hpp"

namespace arcslip {

/// How far a point at which a pair of multipliers leaves the unit circle, or a symmetry breaks, lies from
/// there in the continuation parameter with more harmonics; none of other points, and where none is found.
std::optional<double> moved_by(const TracedBranch& traced, const continuation::BranchPoint& point);

/// One line on what such points of a branch rest on, or nothing where it has none.
std::string describe_stability(const TracedBranch& traced);

}  // namespace arcslip
