#pragma once

// Sector of a ring of solid rectangular section, thin against its radius R. Its centre line moves by u along
// the radius, v along the circumference and w along the axis, its section turns by p about the centre line
// [Love, A treatise on the mathematical theory of elasticity (1927), chapter XXI]:
//
//   2U = int EA e^2 + EI_z k^2 + EI_r b^2 + GJ t^2  R dtheta
//   2T = rho int A (u'^2 + v'^2 + w'^2) + I_p p'^2  R dtheta
//   e = (u + v_t)/R,   k = (v_t - u_tt)/R^2,   b = (R p - w_tt)/R^2,   t = (R p_t + w_t)/R^2
//
// Sections stay plane and normal to the centre line; they have no rotary inertia but that of p. Elements are
// cubic in u and w, with continuous slopes, and quartic in v and p, whose inner values are dofs of the
// element's interior: of every u they take v_t = -u exactly, and do not lock however slender the ring is.
// Frequencies converge as the fourth power of the element's length, from above.

// One that turns about its axis is held by its own hoop tension rho A R^2 Omega^2, which stretches at second
// order
//
//   (e^2 + (u_t - v)^2/R^2)/2
//
// in the plane: K_2 is that times the tension less the mass, G couples u and v. Out of it the tension
// stretches by w_t^2/(2 R^2), and what p adds is of the square of the section's size over R.

#include "arcslip/sectors/finite_sector.hpp"

namespace arcslip {

/// Of u and v, or of w and p.
enum class SolidRingMotion { in_plane, out_of_plane };
/// That of u, of v or of w.
enum class RingDirection { radial, tangential, axial };

/// In any consistent units.
struct SolidRing {
  double radius = 0;  ///< of the centre line
  double width = 0;   ///< of the section, along the axis
  double height = 0;  ///< of the section, along the radius
  /// E, nu and rho; the direction in which the contact rubs; N.
  double youngs_modulus = 0;
  double poisson_ratio = 0;
  double density = 0;
  RingDirection contact = RingDirection::axial;
  Index sectors = 1;
  Index elements = 1;  ///< of one sector
  bool turns = false;  ///< whether what rotation adds is wanted

  /// What the contact moves; the other motion is not coupled with it.
  SolidRingMotion motion() const {
    return contact == RingDirection::axial ? SolidRingMotion::out_of_plane : SolidRingMotion::in_plane;
  }
};

/// Saint-Venant's torsion constant J of a rectangle [Timoshenko and Goodier, Theory of elasticity, article
/// 109], to rounding.
double torsion_constant(double width, double height);

/// The sector, checked. Dofs of a node are u, u_theta, v in the plane and w, w_theta, p out of it; they turn
/// with the sector. Contacts and outputs are those in the direction of the contact of each node but the last.
/// Throws std::invalid_argument unless the quantities are positive, height < 2 radius, -1 < poisson_ratio <
/// 1/2 and the counts at least 1.
FiniteSector ring_sector(const SolidRing& ring);

}  // namespace arcslip
