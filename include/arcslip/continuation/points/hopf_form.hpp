#pragma once

// The normal form of a Hopf point of u' = F(u, p) [Yu. A. Kuznetsov, Elements of Applied Bifurcation Theory,
// 3rd ed., Springer 2004, sections 3.5 and 5.4]: with A = dF/du, A q = j omega q, A^T p = -j omega p, q^H q =
// p^H q = 1, motions in the critical plane are u = 2 Re(z q) with
//
//   z' = j omega z + c z |z|^2 + ...,   l_1 = Re c/omega,
//   2 c = p^H (C(q, q, q*) - 2 B(q, A^{-1} B(q, q*)) + B(q*, (2 j omega - A)^{-1} B(q, q))),
//
// B and C the second and third derivatives of F. Where l_1 < 0 the point is supercritical: cycles that are
// stable within the plane leave it where the equilibrium is not. Where several equal pairs are on the axis
// together, as symmetries have it, there is no such plane and no l_1.

#include <optional>

#include "arcslip/continuation/problem/guess.hpp"
#include "arcslip/continuation/problem/problem.hpp"

namespace arcslip::continuation {

struct HopfForm {
  double omega = 0;     ///< > 0
  double lyapunov = 0;  ///< l_1; nan of several pairs, and where A is singular to the last digit
  double terms = 0;     ///< the sum of the sizes of its three terms
  int pairs = 1;        ///< how many are at +-j omega
  double apart = 1;     ///< |p^H q| over the sum of its terms' sizes: 0 where the pair has one vector alone
  bool poles_passed = false;  ///< whether an odd number of real eigenvalues above 0 enters A^{-1} B(q, q*):
                              ///< l_1 has a pole where one of these vanishes
};

/// At a Hopf point of an equilibrium, of the pair of eigenvalues nearest to +-j omega or, where that is
/// 0, to the imaginary axis. None where derivatives cannot be had or no pair is there.
[[nodiscard]] std::optional<HopfForm> hopf_form(const Problem& problem, const Guess& hopf, double omega = 0);

}  // namespace arcslip::continuation
