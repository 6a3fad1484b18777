#pragma once

// Whether a branch goes round a loop that its start is not on: a step then went over to another branch; or
// along solutions at one value of the parameter; or to and fro in one place. Nothing would end any of these.

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

/// Whether the last points are folds, one after the other, at values of the parameter that are one: it runs
/// to and fro by rounding alone.
bool stands_still(const Problem& problem, const std::vector<BranchPoint>& points, Index active,
                  const Tolerances& tolerances = {});

/// From which point on the branch, whose last point is a fold, has done nothing but turn in one place, or has
/// had points of any type there without end: there are many on a way that is rounding. None where there is no
/// such place.
std::optional<std::size_t> turns_in_place(const std::vector<BranchPoint>& points,
                                          const Tolerances& tolerances = {});

}  // namespace arcslip::continuation
