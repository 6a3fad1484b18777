#pragma once

// Second derivatives of F along one direction, contracted from the left,
//
//   w^T d/dh [dF/du  dF/dp](u + h du, p + h dp)  at h = 0,
//
// which is all that conditions on the Jacobian need for exact gradients. They come from the exact first
// derivatives by central differences, extrapolated [Ridders 1982] until they agree.

#include <functional>

#include "arcslip/continuation/linearization.hpp"

namespace arcslip::continuation {

/// d f/dh at h = 0 of a function that fills a vector, or returns false where it has no value. Steps begin at
/// `step`. Returns the estimated error, in the largest entry; infinity if no difference could be formed.
double differentiate(const std::function<bool(double h, Vector& out)>& f, double step, Vector& derivative);

class SecondDerivative {
 public:
  explicit SecondDerivative(const Problem& problem);

  /// n entries for the unknowns, then one for each parameter. False where F cannot be evaluated around (u,
  /// p).
  bool contract(const Vector& u, const Vector& p, int regime, const Vector& w, const Vector& du,
                const Vector& dp, Vector& out);

  /// Length of a direction in the problem's scale at (u, p): its largest entry.
  double length(const Vector& u, const Vector& p, const Vector& du, const Vector& dp);

 private:
  const Problem& problem_;
  Linearization at_;
  Vector unknown_scale_;
  Vector parameter_scale_;
  Vector row_;
};

}  // namespace arcslip::continuation
