#pragma once

// Forced response of base and damper in one contact dof and one harmonic [paper (31) for rods]:
//
//   R |1 + k phi(R/S) c(eta)| = |y_0(eta)|,   c = c_B + c_D,   S = P K*/K_FD
//
// solved as a relative error in rho = ln R, which is well scaled over all decades:
//
//   g(rho, eta, P) = rho + ln|1 + k phi c| - ln|y_0| = 0
//
// Unknown: rho. Parameters: eta, P. Regimes: stick (R <= S, phi = 1) and slip, with the border ln(R/S) = 0.
// With r = -y_0/(1 + k phi c) the motions are y = -r (1 + k phi c_D) and u = -r k phi c_D.

#include "arcslip/continuation/problem.hpp"
#include "arcslip/continuation/trace.hpp"
#include "arcslip/system.hpp"

namespace arcslip::problems {

class ForcedResponse : public continuation::Problem {
 public:
  enum Parameter : Index { eta, preload };
  enum Regime : int { stick, slip };
  /// Observables in this order; amplitudes and phases as in the columns of branches.csv.
  enum Quantity : Index { R, S, R_over_S, Y, U, beta, alpha, psi, dissipated };

  explicit ForcedResponse(FrictionSystem system) : system_(std::move(system)) {}

  Index size() const override { return 1; }
  std::vector<std::string> parameter_names() const override { return {"eta", "P"}; }
  bool evaluate(const Vector& u, const Vector& p, int regime,
                const continuation::Evaluation& out) const override;
  void scale(const Vector& u, const Vector& p, Vector& unknowns, Vector& parameters) const override;

  std::vector<std::string> regime_names() const override { return {"stick", "slip"}; }
  int border_count(int /*regime*/) const override { return 1; }
  double border(const Vector& u, const Vector& p, int regime, int border,
                continuation::Gradient* gradient) const override;
  int regime_beyond(int regime, int /*border*/) const override { return regime == stick ? slip : stick; }

  std::vector<continuation::Observable> observables() const override;
  void observe(const Vector& u, const Vector& p, int regime, Vector& values) const override;
  /// Y alone has a gradient.
  double observe(const Vector& u, const Vector& p, int regime, Index which,
                 continuation::Gradient& gradient) const override;

  /// Resonances of base, damper and the stuck pair, and the stuck damper's antiresonances, in eta.
  std::vector<double> landmarks(Index parameter, double from, double to) const override;

  /// The solution at (eta, P): stick if it holds, else the slipping one by bracketing.
  continuation::Guess guess(double eta_value, double preload_value) const;

  const FrictionSystem& system() const { return system_; }

 private:
  double log_threshold(double preload_value) const;

  FrictionSystem system_;
};

}  // namespace arcslip::problems
