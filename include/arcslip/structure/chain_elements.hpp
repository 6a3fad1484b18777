#pragma once

// Finite elements of an unwrapped ring of unit circumference, each of length L_e = 1/N, and the load that a
// travelling wave puts on them. Everything is nondimensional, in the time scale 2 pi/Omega_D of the damper.

#include "arcslip/structure/precise.hpp"
#include "arcslip/types.hpp"

namespace arcslip {

/// One element with its dofs ordered (left node, right node), J dofs to a node.
struct ChainElement {
  PreciseMatrix mass;         ///< 2J x 2J
  PreciseMatrix stiffness;    ///< 2J x 2J
  PreciseComplexVector load;  ///< 2J: int_0^{L_e} e^{-ja xi/L_e} phi_k(xi) d xi, for a unit load per length
};

/// Propagation constant a = 2 pi n/N: the phase by which each node lags the one before it [paper (2)].
PreciseReal propagation_constant(Index wave_number, Index elements);

/// int_0^1 s^p e^{-jas} ds for 0 <= a <= pi, by its power series in a, which converges to rounding for every
/// such a and needs no switch where the closed form cancels.
PreciseComplex travelling_moment(int power, const PreciseReal& a);

/// Longitudinal rod, J = 1, linear shape functions [paper (20)].
ChainElement rod_element(double mass_ratio, double stiffness_ratio, Index wave_number, Index elements);

/// Transverse beam, J = 2 (deflection and slope), cubic Hermite shape functions [paper (33)-(36)].
ChainElement beam_element(double mass_ratio, double stiffness_ratio, Index wave_number, Index elements);

}  // namespace arcslip
