#pragma once

// Whether a branch goes round a loop that its start is not on: a step then went over to another branch, and
// nothing would end it.

#include <optional>
#include <vector>

#include "arcslip/continuation/path/branch.hpp"
#include "arcslip/continuation/path/tolerances.hpp"
#include "arcslip/continuation/problem/problem.hpp"

namespace arcslip::continuation {

/// Which earlier point the last one, a fold, is again, passed in the same direction after the branch went far
/// from it; `active` is the parameter that varies. None where there is none.
std::optional<std::size_t> came_round(const Problem& problem, const std::vector<BranchPoint>& points,
                                      Index active, const Tolerances& tolerances = {});

}  // namespace arcslip::continuation
