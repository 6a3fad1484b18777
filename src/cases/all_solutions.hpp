#pragma once

// All solutions that a case asks for, and whether these are all.

#include "arcslip/cases/runs.hpp"
#include "arcslip/problems/tasks/all_solutions.hpp"

namespace arcslip {

/// By deflation and branches from the guess and, of a small problem, from a box around it or the one that the
/// case names; of formulas also by interval arithmetic. Throws InputError where the box does not fit.
problems::AllSolutions find_all_solutions(const CaseBranch& request, const Subject& subject,
                                          const continuation::TimeBudget& time);

}  // namespace arcslip
