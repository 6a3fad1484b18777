#pragma once

// Sector of a thin annular plate of constant thickness, for waves out of its plane. Energies in the polar
// coordinates (r, theta) [Leissa, Vibration of plates, NASA SP-160 (1969), chapter 1]:
//
//   2U = D int (k_r + k_t)^2 - 2 (1 - nu) (k_r k_t - k_rt^2) r dr dtheta,   D = E h^3/(12 (1 - nu^2))
//   2T = rho h int w'^2 r dr dtheta
//   k_r = w_rr,   k_t = w_r/r + w_tt/r^2,   k_rt = w_rt/r - w_t/r^2
//
// in elements with cubic Hermite polynomials of r times such of theta, which conform. Their dofs, four to a
// node, are w, w_r, w_theta and w_r,theta: they turn with the sector, so that its boundaries pair as they
// are. Frequencies converge as the fourth power of the element's length, from above.
//
// Of a plate that turns about its axis at Omega the stresses in its plane [Timoshenko and Goodier, Theory of
// elasticity, article 32]
//
//   s_r = A - B/r^2 - (3 + nu)/8 rho Omega^2 r^2,   s_t = A + B/r^2 - (1 + 3 nu)/8 rho Omega^2 r^2
//
// stiffen it by h int s_r w_r^2 + s_t (w_t/r)^2 r dr dtheta [Lamb and Southwell, Proceedings of the Royal
// Society A 99 (1921)]. s_r = 0 where an edge is free or supported, which slides in its plane, and a clamped
// one keeps its radius. Motion along the axis meets neither Coriolis' force nor the centrifugal one.

#include "arcslip/sectors/finite_sector.hpp"

namespace arcslip {

/// What an edge is held by: nothing, w = 0, or w = w_r = 0.
enum class EdgeSupport { free, supported, clamped };

/// In any consistent units.
struct AnnularPlate {
  /// Radii, thickness h, Young's modulus E, Poisson's ratio nu and density rho; what holds the edges; how
  /// many sectors the plate has, and how many elements one of them.
  double inner_radius = 0;
  double outer_radius = 0;
  double thickness = 0;
  double youngs_modulus = 0;
  double poisson_ratio = 0;
  double density = 0;
  EdgeSupport inner_edge = EdgeSupport::clamped;
  EdgeSupport outer_edge = EdgeSupport::free;
  Index sectors = 1;
  Index radial_elements = 1;
  Index angular_elements = 1;  ///< of one sector
  bool turns = false;          ///< whether what rotation adds to the stiffness is wanted
};

/// The sector, checked. Nodes count along the radius from inside, then from left to right; dofs that the
/// edges hold are left out. Contacts and outputs are w of the outer edge's nodes but the last, if they can
/// move; no load. Throws std::invalid_argument unless 0 < inner_radius < outer_radius, -1 < poisson_ratio <
/// 1/2, the other quantities are positive and the counts at least 1.
FiniteSector annular_plate_sector(const AnnularPlate& plate);

}  // namespace arcslip
