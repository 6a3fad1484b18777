#pragma once

// How fast structures turn while they vibrate, in coordinates that turn with them:
//
//   Z(w, Omega) = K + Omega^2 K_2 + j w (C + Omega G) - w^2 M
//
// with the gyroscopic matrix G, real and skew, which does no work, and K_2, what centrifugal forces make of
// the stiffness at Omega = 1. In case files and here a speed is in revolutions, as eta is in periods, in the
// unit of time: Omega = 2 pi times it. An engine order m, a load that stands still and has m waves round the
// circumference, has the frequency eta = m times the speed.

namespace arcslip {

/// Of a structure that vibrates at eta.
struct Rotation {
  double fixed = 0;    ///< the speed, in revolutions, or what of it does not follow eta
  double per_eta = 0;  ///< 1/m where eta is that of an engine order m

  double at(double eta) const { return fixed + per_eta * eta; }
  bool is_none() const { return fixed == 0 && per_eta == 0; }
  friend bool operator==(const Rotation&, const Rotation&) = default;
};

}  // namespace arcslip
