#pragma once

// Forced response of base and damper in one contact dof and one harmonic [paper (31) for rods]:
//
//   R |1 + k phi(R/S) c(eta)| = |y_0(eta)|,   c = c_B + c_D,   S = (P + P_2 eta^2) K*/K_FD
//
// solved as a relative error in rho = ln R, which is well scaled over all decades:
//
//   g(rho, eta, P) = rho + ln|1 + k phi c| - ln|y_0| = 0
//
// Unknown: rho. Parameters: eta, P. Regimes: stick (R <= S, phi = 1) and slip, with the border ln(R/S) = 0.
// With r = -y_0/(1 + k phi c) the motions are y = -r (1 + k phi c_D) and u = -r k phi c_D.
//
// Where Im c <= 0, as in any passive system, dg/drho > 0 at every R, whatever S is: the response at given
// (eta, P) is unique, and no branch in eta or P can fold or turn at a corner. A preload that grows with eta
// changes S alone and keeps it so. With negative damping of the base Im c > 0 occurs, and folds with it.

#include "arcslip/problems/response/contact_problem.hpp"

namespace arcslip::problems {

/// The equation above.
class ForcedResponse : public ContactProblem {
 public:
  /// Of a system without cubic springs.
  explicit ForcedResponse(FrictionSystem system);

  Index size() const override { return 1; }
  bool is_regular(const continuation::Regime& regime) const override {
    return is_passive_ || regime[0] == stick;
  }
  bool is_linear(const continuation::Regime& regime) const override { return regime[0] == stick; }
  [[nodiscard]] bool evaluate(const Vector& u, const Vector& p, const continuation::Regime& regime,
                              const continuation::Evaluation& out) const override;

  /// Those of every contact problem, then the amplitudes of the system's outputs. All have
  /// gradients.
  std::vector<continuation::Observable> observables() const override;
  void observe(const Vector& u, const Vector& p, const continuation::Regime& regime,
               Vector& values) const override;
  double observe(const Vector& u, const Vector& p, const continuation::Regime& regime, Index which,
                 continuation::Gradient& gradient) const override;

  /// r, whose modulus the unknown has.
  ComplexVector motions(const Vector& u, const Vector& p, const continuation::Regime& regime) const override {
    return ComplexVector::Constant(1, motion(state(u(0), p, regime), u(0)));
  }

  /// The solution at (eta, P), of several the one with the smallest R: stick if it holds, else the slipping
  /// one by bracketing. Throws std::invalid_argument where the response has no value.
  continuation::Guess guess(double eta_value, double preload_value) const;

 private:
  double observe_base(const Vector& u, const Vector& p, const continuation::Regime& regime,
                      continuation::Gradient& gradient) const;
  /// r of this modulus, with the phase that the equation gives it.
  static Complex motion(const State& at, double log_R);

  bool is_passive_;  // whether Im c <= 0 everywhere
};

}  // namespace arcslip::problems
