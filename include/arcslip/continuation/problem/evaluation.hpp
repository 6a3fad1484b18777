#pragma once

// A problem's values, checked as they come: a problem may resize the targets that it is given, or forget some
// of their entries, which nothing that follows would notice.

#include "arcslip/continuation/problem/problem.hpp"

namespace arcslip::continuation {

/// Problem::evaluate. The entries of dense targets are set to a nan of its own kind first, so that those that
/// are not filled are known. Throws std::logic_error that names what was resized or not filled. False also
/// where F is not finite.
[[nodiscard]] bool evaluate(const Problem& problem, const Vector& u, const Vector& p, const Regime& regime,
                            const Evaluation& out);

/// Calls all other functions that a branch in this regime relies on, with gradients of the observables
/// `tracked`. Throws std::logic_error that names the first of them that gives too much or too little.
void check_functions(const Problem& problem, const Vector& u, const Vector& p, const Regime& regime,
                     const std::vector<Index>& tracked);

}  // namespace arcslip::continuation
