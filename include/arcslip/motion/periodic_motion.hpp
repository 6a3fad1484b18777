#pragma once

// A periodic motion of any harmonics as it passes in time, theta = w t:
//
//   x(theta) = Re sum_h x_h e^{jh theta},   h = 0, 1, 2, ...,   x_0 real,
//
// perhaps with a drift v theta that it has beside.

#include <span>
#include <vector>

#include "arcslip/types.hpp"

namespace arcslip {

/// A trigonometric polynomial. Immutable.
class PeriodicMotion {
 public:
  /// x_0, x_1, ..., x_H, of at least one; the imaginary part of x_0 does not count.
  explicit PeriodicMotion(ComplexVector coefficients);

  /// `orders` are the h >= 0, different ones, with one coefficient each; other harmonics up to `highest` are
  /// zero.
  PeriodicMotion(std::span<const int> orders, const ComplexVector& coefficients, int highest);

  /// The same with so much drift per theta.
  PeriodicMotion drifting(double drift) const;

  /// v.
  double drift() const { return drift_; }

  /// H.
  int highest() const { return static_cast<int>(coefficients_.size()) - 1; }

  /// x_0, ..., x_H.
  const ComplexVector& coefficients() const { return coefficients_; }

  /// Value and derivative at one theta.
  struct Local {
    double value;  ///< x
    double first;  ///< dx/dtheta
  };
  Local at(double theta) const;  ///< theta

  /// x(theta).
  double value(double theta) const { return at(theta).value; }

  /// dx/dtheta, which has no drift.
  PeriodicMotion derivative() const;

  /// All theta of [0, 2 pi) at which the sign of x changes, in ascending order, but pairs of them closer than
  /// 1e-8; beside them there may be points at which x is zero to rounding. Bounds on derivatives, not
  /// samples, tell that none is left. None of a constant; of motions without drift.
  std::vector<double> zeros() const;

 private:
  ComplexVector coefficients_;
  double drift_ = 0;
};

}  // namespace arcslip
