#pragma once

// What a flow round the base does to it: the field's influence coefficients, and damping by nodal diameter.
//
// In each mode of the base sector i feels the motion of its neighbours by so much per modal mass,
//
//   q_i'' + ... = sum_k L_k q_{i+k},     A(a) = sum_k L_k e^{-jka}  under a wave, a = 2 pi n/N,
//
// which the wave's d_k has less: one number for each mode, that the harmonic balance, the flows of
// disturbances and the motion of all nodes take alike, and whose derivatives are closed. It does not couple
// the modes of a wave, as it does not where modes keep their shapes. A mass or a rod's node has L_k over its
// mass. Im A > 0 feeds the wave: its damping ratio is -Im A/(2 w_0^2), to the first order.
//
// Real L_k hold at all frequencies. A complex one is meant at that of the first harmonic, and has no motion
// in time.
//
// A damping ratio zeta_n of n nodal diameters is, at a mode's own frequency, that of the wave n. What both
// ways round have alike acts as a dashpot of each mode; what differs, as in a flow that runs round, can only
// be one of real coefficients: A(a) = -j (zeta_n - zeta_-n) w_k^2.

#include <memory>
#include <vector>

#include "arcslip/structure/contact_modes.hpp"

namespace arcslip {

struct FrictionSystem;
struct SystemParameters;

/// Immutable.
struct Influence {
  /// L_k, in the units of a square of a circular frequency.
  struct Coefficient {
    Index neighbour;  ///< k: force on sector i of the motion of sector i + k
    Complex value;    ///< L_k
  };
  /// Of one nodal diameter; below 0 of the wave that runs against the numbers of the sectors.
  struct WaveDamping {
    Index wave;   ///< n
    double zeta;  ///< beside the base's own
  };

  std::vector<Coefficient> coefficients = {};  ///< 0 of other neighbours
  std::vector<WaveDamping> damping = {};       ///< of n >= 0 that of -n as well, unless that is listed
  std::vector<Index> modes = {};               ///< of the base under each wave, from 0; empty: all of them

  /// Whether a coefficient is.
  bool is_complex() const;

  /// A(a) under a wave of any whole number round N = `nodes`. Real where the wave is its own conjugate,
  /// unless a coefficient is complex.
  Complex coefficient(Index wave, Index nodes) const;

  /// The damping ratio of a wave, 0 of one that is not listed.
  double zeta(Index wave, Index nodes) const;

  /// Of the ring in which waves that run with the numbers of the sectors run against them.
  Influence other_way() const;

  /// On a mode of this frequency under a wave; `rate`: w over eta. Throws std::invalid_argument of a rigid
  /// motion that coefficients move.
  ModeInfluence on(double frequency, Index wave, Index nodes, double rate) const;
};

/// Puts that of `parameters`, if it has any, on base and outputs of its wave. Throws std::invalid_argument
/// where the base is no sum of modes.
void add_influence(const SystemParameters& parameters, ContactSystem& wave);
void add_influence(const SystemParameters& parameters, FrictionSystem& wave);

}  // namespace arcslip
