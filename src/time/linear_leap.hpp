#pragma once

#include <vector>

#include "arcslip/time/ring_motion.hpp"

namespace arcslip {

/// The flow of a ring over a time in which few forces vary, and as linear ones, f = G x + m. Modes move in
/// closed form under the forces, of which a collocation at Chebyshev points keeps the histories:
///
///   x(t) = x_free(t) - int_0^t X b(t - s) X^T f(s) ds,   b the response of modes to an impulse.
///
/// Its cost goes with the number of these forces, not with that of all modes squared.
class LinearLeap {
 public:
  /// Over `length`, at most `reach` of the rate's inverse.
  LinearLeap(const Ring& ring, const VaryingForces& forces, double rate, double length);

  static constexpr double reach = 20;

  /// Whether this is the better way: damping so small that modes may be followed backwards, and few forces.
  static bool pays(const Ring& ring, const VaryingForces& forces, double length);

  /// Takes positions and velocities on, D columns each; `constant` is m, a row for each of the forces.
  void take(const Matrix& constant, Matrix& position, Matrix& velocity) const;

 private:
  Matrix gain_;     ///< G
  Matrix free_;     ///< x at all points by (p, v)
  Matrix history_;  ///< I + M G, M the collocation of the integral
  Matrix by_force_;
  Eigen::Matrix<double, Eigen::Dynamic, 4> end_;  ///< of each mode p by p and v, v by p and v
  Matrix pushed_;                                 ///< (p, v) at the end by forces at all points
};

}  // namespace arcslip
