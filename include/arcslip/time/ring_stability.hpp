#pragma once

// Stability of a settled response by the Floquet multipliers of the exact piecewise-linear flow.
//
// The multipliers nu of G (ring_response.hpp) take 1/N of the n periods that those of the period need. G
// commutes with the flow Phi over one period T, and G^N = Phi^n, so a disturbance that both leave alone but
// for a factor, nu for G and mu for Phi, has
//
//   nu^N = mu^n,   |mu| = |nu|^{N/n},   and mu = nu^N where n = 1
//
// and it is a wave on the response, of node i as of node 1 with the response's own delay:
//
//   delta_i(t) = e^{lambda t} e^{-2 pi j l (i-1)/N} q(t - (i-1) nT/N),   q(t + T) = q(t)
//   nu = e^{lambda nT/N} e^{-2 pi j l/N},   mu = e^{lambda T}
//
// where l, its wave number, has a meaning only together with lambda: (lambda + j m w*, l + m n) is the same
// wave. Where no contact slips and q is constant, l is the wave number of a linear mode. For n > 1 the n
// values of mu that one nu allows differ in phase alone, so that nu decides on stability. nu = 1 is a fold or
// a branch point of travelling responses; at any other nu of modulus 1 a response branches off that travels
// no more.
//
// What says nothing of stability is left out: the multipliers of neutral drifts, and the memory of elements
// that never change their phase, or that none of their changes touch, which then are constants of the motion.
// Memory that the phase at the start does not need is no free state; it and what other elements forget give
// multipliers 0. Where no contact slips and the damper is free, a pair of |mu| = 1 remains: base against
// damper as rigid bodies on the springs of the contacts, which no damping proportional to stiffness reaches.
// For n = 0, nu = mu.

#include "arcslip/time/ring_response.hpp"

namespace arcslip {

/// Stability of a fixed point of G.
struct RingStability {
  ComplexVector turned;  ///< nu, of falling modulus; 2D + M less drifts and memory that never changes
  double periods;        ///< N/n, or 1
  bool slips;            ///< whether any element changes its phase

  /// The largest |mu|: the growth of the worst disturbance in one period T.
  double growth() const;

  /// Multipliers outside the unit circle by more than `margin` in |mu|.
  Index unstable(double margin = 0) const;
};

/// For a settled state: one with G(s) = s.
RingStability floquet_stability(RingMotion& motion, const RingState& state);

/// Derivative of (position, velocity, memory) over one period T, (2D + M) x (2D + M): its eigenvalues are mu,
/// with 1 for a drift. Costs N/n times what G does.
Matrix monodromy(RingMotion& motion, const RingState& state);

}  // namespace arcslip
