#pragma once

// All solutions that a case asks for, and whether these are all.

#include "arcslip/cases/runs.hpp"

namespace arcslip {

/// The solutions with what is known of their list.
struct AllSolutions {
  std::vector<continuation::Guess> solutions;  ///< in the order found
  SolutionCount count;
};

/// By deflation and branches from the guess and, of a small problem, from a box around it or the one that the
/// case names; of formulas also by interval arithmetic. Throws InputError where the box does not fit.
AllSolutions find_all_solutions(const CaseBranch& request, const Subject& subject,
                                const continuation::TimeBudget& time);

}  // namespace arcslip
