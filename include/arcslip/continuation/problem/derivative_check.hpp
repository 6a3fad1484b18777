#pragma once

// Exact derivatives against differences of the values they belong to.

#include <string>

#include "arcslip/continuation/problem/problem.hpp"

namespace arcslip::continuation {

/// The derivative that is furthest off.
struct [[nodiscard]] DerivativeReport {
  double worst = 0;   ///< largest |exact - difference|/(1 + |exact|), in the problem's scale
  std::string where;  ///< the entry it belongs to, as "dF0/du1", "dF0/dP", "d Y/du0" or "d border 0/d P"
};

/// Compares Jacobian, parameter derivatives, and the gradients of borders and observables at (u, p) with
/// central differences, extrapolated once (error of order h^4). The point must lie at least 1e-3 of the scale
/// inside its regime. Borders and observables may have kinks there, as a maximum in two places has: any slope
/// between those of both sides is one.
///
/// A sparse Jacobian is compared by groups of columns without a common row, of which there are about as many
/// as its fullest row has entries. Entries that its pattern lacks are found, too, and named as "dF0/du7,
/// which the pattern lacks". Gradients by more than 1000 unknowns are compared in 20 random directions. Where
/// several unknowns were moved at once and the difference is below 1e-6, `where` has no number, as "dF0/du".
DerivativeReport check_derivatives(const Problem& problem, const Vector& u, const Vector& p,
                                   const Regime& regime);

}  // namespace arcslip::continuation
