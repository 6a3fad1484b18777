#pragma once

// Exact derivatives against differences along one direction: cheap enough to be taken wherever a branch is
// traced, and silent where differences tell nothing.

#include <optional>
#include <string>
#include <vector>

#include "arcslip/continuation/problem/problem.hpp"

namespace arcslip::continuation {

/// Compares the derivatives of F, of the borders, and of the observables in `observables`, with central
/// differences along one direction in which all unknowns and the parameters in `parameters` move, at a price
/// of two values of each. Where these differ by more than 1e-5 of what the derivatives' entries give, at
/// every one of five steps that agree with one another, the entry is looked for and named: "the Jacobian
/// differs from differences of the residual by 5 % in dF0/du1". Corners and borders within a step, rounding,
/// and what is sharper than the steps make these disagree, and then nothing is said.
[[nodiscard]] std::optional<std::string> find_wrong_derivative(const Problem& problem, const Vector& u,
                                                               const Vector& p, const Regime& regime,
                                                               const std::vector<Index>& parameters,
                                                               const std::vector<Index>& observables);

}  // namespace arcslip::continuation
