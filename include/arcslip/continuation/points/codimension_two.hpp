#pragma once

// Normal forms of the points of codimension two on curves of folds and of Hopf points [Yu. A. Kuznetsov,
// Elements of Applied Bifurcation Theory, 3rd ed., Springer 2004, ch. 8; SIAM J. Numer. Anal. 36 (1999)
// 1104], on the centre manifold with vectors as centre_manifold.hpp has them:
//
//   cusp                w' = c w^3
//   Bogdanov-Takens     w_0' = w_1, w_1' = a w_0^2 + b w_0 w_1;   |q_0| = 1, a > 0
//   generalised Hopf    w' = j omega w + c_1 w |w|^2 + c_2 w |w|^4,   l_2 = Re c_2/omega
//   zero-Hopf           v' = b v^2 + c |w|^2,   w' = j omega w + d v w + e v^2 w,   b, c and e real, of time
//                       that runs at a speed 1 + k v;   b > 0, s = sign(b c), theta = Re d/b
//   double Hopf         r_1' = r_1 (p_11 r_1^2 + p_12 r_2^2), r_2' = r_2 (p_21 r_1^2 + p_22 r_2^2)
//                       theta = p_12/p_22, delta = p_21/p_11

#include <optional>
#include <string>
#include <vector>

#include "arcslip/continuation/path/branch.hpp"
#include "arcslip/continuation/points/extended_problem.hpp"

namespace arcslip::continuation {

struct Coefficient {
  std::string name;
  double value = 0;
};

/// cusp `c`; Bogdanov-Takens `a`, `b`; generalised Hopf `omega`, `l2`; zero-Hopf `omega`, `b`, `c`, `d` (its
/// real part), `e`, `s`, `theta`; double Hopf `omega_1`, `omega_2`, `p11`, `p12`, `p21`, `p22`, `theta`,
/// `delta`.
struct NormalForm {
  std::vector<Coefficient> coefficients;
  double error = 0;  ///< estimated, of the largest one; 0 where derivatives are exact
  /// Of cusps: whether both parameters unfold it; else, as where a fold reaches the trivial state of a
  /// symmetric system, the curve is none of cusps nearby.
  bool is_regular = true;
};

/// Of a point on a curve of folds, of Hopf points of equilibria, or of maps where it is a cusp; none of other
/// points, and where F cannot be evaluated around it or an eigenvalue is a further multiple of the
/// imaginary parts. `parameter` is the second of the curve's.
[[nodiscard]] std::optional<NormalForm> codimension_two_form(const ExtendedProblem& curve, Index parameter,
                                                             const BranchPoint& point);

}  // namespace arcslip::continuation
