#pragma once

// A linear stretch of a ring's motion as one matrix, by a series over a short time that is doubled: of few
// coordinates, where each step would take all columns of a derivative through it.

#include "arcslip/time/ring_motion.hpp"

namespace arcslip {

/// Between events, with forces that are linear.
class DenseLeap {
 public:
  /// Whether it costs less than steps over this length times the fastest rate: of one node, whose coordinates
  /// are not told apart by waves.
  static bool pays(const Ring& ring, const VaryingForces& forces, double reach);

  /// Of this length; `rate` bounds the eigenvalues.
  DenseLeap(const RingMotion& motion, const VaryingForces& forces, double length);

  /// Takes columns of positions and velocities on, under constant forces against the forces' coordinates.
  void take(const Matrix& constant, Matrix& position, Matrix& velocity) const;

 private:
  Matrix by_state_;  ///< 2D x 2D
  Matrix by_force_;  ///< 2D x forces
};

}  // namespace arcslip
