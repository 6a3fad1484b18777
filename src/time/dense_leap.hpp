#pragma once

// A linear stretch of a ring's motion in one go. Of p'' + C p' + K p = m the response S to an impulse tells
// all of the flow, since that commutes with its own equation:
//
//   p(t) = S' p + S (C p + v) + int_0^t S ds m,   v(t) = S' v - S K p + S m
//
// S and S' come of a series over a short time, which is doubled:
//
//   S(2t) = S' S + S (S' + C S),   S'(2t) = S' S' - S K S
//
// in four products of D x D whatever the pattern of phases, and for whichever D x D matrices C and K; in
// three where these are symmetric.

#include "arcslip/time/ring_motion.hpp"

namespace arcslip {

/// Between events, with forces that are linear.
class DenseLeap {
 public:
  /// Whether it costs less than series for this many columns over this length times the fastest rate.
  static bool pays(const RingMotion& motion, const VaryingForces& forces, double reach, Index columns);

  /// Of this length. Refers to both, which must outlive it.
  DenseLeap(const RingMotion& motion, const VaryingForces& forces, double length);

  /// Takes columns of positions and velocities on, under constant forces against the forces' coordinates.
  void take(const Matrix& constant, Matrix& position, Matrix& velocity) const;

 private:
  Matrix stiff(const Matrix& position) const;
  Matrix damped(const Matrix& velocity) const;
  void flow(Matrix& position, Matrix& velocity) const;

  const RingMotion& motion_;
  const VaryingForces& forces_;
  Matrix gain_;
  Matrix response_;         ///< S
  Matrix rate_;             ///< S'
  Matrix pushed_;           ///< D x forces: int S ds X^T
  Matrix pushed_velocity_;  ///< D x forces: S X^T
};

}  // namespace arcslip
