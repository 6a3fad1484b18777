#pragma once

// The complete ring of N nodes, base and damper, with a Jenkins element between them at each node. Nothing is
// taken from the travelling wave but the load. With q the displacements of all nodes, b_i the difference
// u_i - y_i of contact i and g_i its friction force,
//
//   M q'' + C q' + K q + sum_i b_i g_i = Re(sum_h F_h e^{jhw*t}),   w* = 2 pi eta,   C = (beta/2 pi) K of
//   each structure g_i = k (r_i - x_i) in stick, +-k S in slip,           r_i = b_i^T q,   x_i the place of
//   the slider
//
// where node i carries the load of node 1 times e^{-ja(i-1)}. It is held in the undamped modes of the two
// uncoupled structures, q = Phi p, which leave every matrix but that of the contacts diagonal:
//
//   p'' + D p' + W p + B^T g + sum X^T f(x) = Re(sum_h L_h e^{jhw*t}),   r = B p,   x = X p
//
// with further elements f(x) in coordinates x of base or damper. Where the damper is free, base and damper
// can move together as one rigid body. No force of this model does it, unless elements hold one of them to
// ground: that coordinate stays at rest and is left out.

#include <optional>

#include "arcslip/assembly/coordinates.hpp"
#include "arcslip/assembly/system.hpp"

namespace arcslip {

/// Elements without memory beside the contacts, the same at each node.
struct RingElements {
  Matrix motion;                           ///< N x D: x = motion p
  std::shared_ptr<const Element> element;  ///< one of them

  /// Its force.
  const PiecewiseLaw& law() const { return *element->law(); }
};

/// One harmonic of the load.
struct RingLoad {
  int order;                ///< h
  ComplexVector amplitude;  ///< D: L of Re(L e^{jhw*t})
};

/// Modal form of the ring; D coordinates, N contacts. Time is nondimensional: one period is 1/eta.
struct Ring {
  Vector stiffness;  ///< D: diagonal of W, squares of the circular frequencies 2 pi eta_k
  Vector damping;    ///< D: diagonal of D
  Matrix base;       ///< N x D: contact dofs y = base p
  Matrix damper;     ///< N x D: contact dofs u = damper p
  Matrix relative;   ///< N x D: B = damper - base
  Matrix turn;       ///< D x D, orthogonal: the motion in which each node does what the next one did

  Index wave_number;                 ///< n
  double contact_stiffness;          ///< k = K_FD/N
  double slip_per_preload;           ///< S/P
  double preload_growth;             ///< P_2
  std::vector<RingElements> others;  ///< beside the contacts
  std::vector<RingLoad> loads;       ///< that act
  std::optional<Index> drift;        ///< the coordinate, if any, of a rigid motion that contacts alone resist

  /// N and D.
  Index nodes() const { return relative.rows(); }
  Index coordinates() const { return relative.cols(); }

  /// A bound on the moduli of the eigenvalues of the ring, whichever contacts stick.
  double fastest_rate() const;
};

/// Assembles the ring. Throws std::invalid_argument for sectors, for damping that is not viscous and for
/// elements with memory beside the contacts.
Ring build_ring(const SystemParameters& parameters);

}  // namespace arcslip
