#pragma once

// Second derivatives of F along one direction, contracted from the left,
//
//   w^T d/dh [dF/du  dF/dp](u + h du, p + h dp)  at h = 0,
//
// which is all that conditions on the Jacobian need for exact gradients. They are the problem's own where it
// gives them. Else they come from the exact first derivatives by central differences, extrapolated [Ridders
// 1982] until they agree.

#include <functional>

#include "arcslip/continuation/problem/linearization.hpp"

namespace arcslip::continuation {

/// How good a derivative by differences is.
struct Difference {
  double error = 0;     ///< estimated, of the largest entry; infinity if no difference could be formed
  bool agrees = false;  ///< whether differences have come to agree
  int level = 0;        ///< the finest that was taken, of steps that are each a quarter of the one before
};

/// d f/dh at h = 0 of a function that fills a vector, or returns false where it has no value. Steps begin at
/// `step` times 4^-`level`, and end at `step` times 4^-`most` at the latest.
Difference differentiate(const std::function<bool(double h, Vector& out)>& f, double step, Vector& derivative,
                         int level = 0, int most = 100);

/// Serves one thread. The problem is kept by reference.
class SecondDerivative {
 public:
  /// Nothing is evaluated yet.
  explicit SecondDerivative(const Problem& problem);

  /// n entries for the unknowns, then one for each parameter. False where F cannot be evaluated around (u,
  /// p).
  [[nodiscard]] bool contract(const Vector& u, const Vector& p, const Regime& regime, const Vector& w,
                              const Vector& du, const Vector& dp, Vector& out);

  /// The same with several w at once, the columns of `weights`, n x k: (n + number of parameters) x k.
  [[nodiscard]] bool contract(const Vector& u, const Vector& p, const Regime& regime, const Matrix& weights,
                              const Vector& du, const Vector& dp, Matrix& out);

  /// Length of a direction in the problem's scale at (u, p): its largest entry.
  double length(const Vector& u, const Vector& p, const Vector& du, const Vector& dp);

  /// Of the problem so far, with its derivatives.
  long evaluations() const { return at_.evaluations() + own_; }

  /// What is kept from one place to the next, a whole number.
  double& memory() { return level_; }

 private:
  [[nodiscard]] bool ask(const Vector& u, const Vector& p, const Regime& regime, const Matrix& weights,
                         const Vector& du, const Vector& dp, Matrix& out);
  [[nodiscard]] bool difference(const Vector& u, const Vector& p, const Regime& regime, const Matrix& weights,
                                const Vector& du, const Vector& dp, Matrix& out);

  const Problem& problem_;
  Linearization at_;
  Vector unknown_scale_;
  Vector parameter_scale_;
  Vector row_;
  Vector weight_;
  Vector own_row_;
  double level_ = 0;  // of the steps that came to agree last
  long own_ = 0;
};

}  // namespace arcslip::continuation
