#pragma once

// Forced response of a base with cubic springs to ground at its contact dofs, of force k_3 y^3 each, and of a
// damper on it. In one harmonic balance, under a travelling wave, the springs pull with kappa y,
//
//   y = y_0 + c_B (k phi r - kappa y),   u = -c_D k phi r,   r = u - y,   kappa = 3/4 k_3 |y|^2.
//
// Hence y = -r q with q = 1 + k phi c_D, and r (q (1 + kappa c_B) + k phi c_B) = -y_0; in moduli, with
// rho = ln R and lambda = ln Y,
//
//   lambda - rho - ln|q| = 0
//   rho + ln|q (1 + kappa c_B) + k phi c_B| - ln|y_0| = 0.
//
// Unknowns: rho, lambda. Parameters: eta, P. Regimes and border as in ForcedResponse, which this is where
// k_3 = 0 [Duffing 1918 where there is no friction: |1/c_B + 3/4 k_3 Y^2| Y = |y_0/c_B|].

#include "arcslip/problems/response/contact_problem.hpp"

namespace arcslip::problems {

/// The equations above.
class CubicResponse : public ContactProblem {
 public:
  /// Of a system with cubic_stiffness >= 0.
  using ContactProblem::ContactProblem;

  Index size() const override { return 2; }
  [[nodiscard]] bool evaluate(const Vector& u, const Vector& p, const continuation::Regime& regime,
                              const continuation::Evaluation& out) const override;

  void observe(const Vector& u, const Vector& p, const continuation::Regime& regime,
               Vector& values) const override;
  /// Y alone has a gradient.
  double observe(const Vector& u, const Vector& p, const continuation::Regime& regime, Index which,
                 continuation::Gradient& gradient) const override;

  /// r and y.
  ComplexVector motions(const Vector& u, const Vector& p, const continuation::Regime& regime) const override;

  /// The solution at (eta, P), of several the one with the smallest R. Throws std::invalid_argument where the
  /// response has no value.
  continuation::Guess guess(double eta_value, double preload_value) const;

 private:
  double log_lower_bound(const Vector& p) const;
  double spring(const Vector& u) const;  // kappa
};

}  // namespace arcslip::problems
