#pragma once

// Self-excited vibration without forcing: a base with negative damping zeta_B, held by the friction of one
// contact dof in one harmonic. With y_0 = 0 the response equation r (1 + k phi c) = -y_0 leaves
//
//   1 + k phi(R/S) c(eta; zeta_B) = 0,   c = c_B + c_D,   S = (P + P_2 eta^2) K*/K_FD,
//
// one complex equation: its real and its imaginary part. Unknowns: eta and ln R. Parameters: zeta_B, P. eta
// is not taken as a logarithm: it stays near a resonance, and its own value as its scale does the same.
//
// The only regime is slip, for a sticking contact is linear: its border ln(R/S) = 0, where the cycle shrinks
// onto the border of stick, ends the branch. A base of one mode on a held damper (c_D = 0) has
//
//   k Im phi = -delta eta_1^2/a_1,   k Re phi = (eta^2 - eta_1^2)/a_1,
//
// delta = 2 zeta_B (structural) or 2 zeta_B eta/gamma (viscous): a cycle folds in zeta_B where Im phi, or
// Im phi/eta, is largest. Im phi is largest at R = 2 S, with 1/pi. Of the two cycles at a zeta_B the small
// one, where -zeta_B rises with R, is stable: a larger amplitude loses more than the base feeds in. The large
// one is unstable, and beyond it vibration grows without bound, as it does for all zeta_B below the fold.
//
// phi depends on R/S alone, so that eta, R/S and zeta_B determine one another whatever the preload is: P
// scales R, and a branch in P has no fold, whether P_2 is zero or not.

#include "arcslip/assembly/system.hpp"
#include "arcslip/continuation/path/trace.hpp"
#include "arcslip/continuation/problem/problem.hpp"

namespace arcslip::problems {

/// The equations above.
class LimitCycle : public continuation::Problem {
 public:
  /// Positions of the unknowns, and of zeta_B and P.
  enum Unknown : Index { eta, log_R };
  enum Parameter : Index { zeta, preload };
  /// Observables in this order, `dissipated` over k S^2 as in ForcedResponse. The phase is arbitrary.
  enum Quantity : Index { frequency, R, S, R_over_S, Y, U, dissipated, T_max, slip };
  /// Which cycle is wanted of those at one zeta_B.
  enum class Size { any, small, large };

  /// The base's damping in `system` is replaced by the parameter zeta_B; its kind is kept.
  explicit LimitCycle(FrictionSystem system);

  Index size() const override { return 2; }
  std::vector<std::string> parameter_names() const override { return {"zeta_B", "P"}; }
  [[nodiscard]] bool evaluate(const Vector& u, const Vector& p, const continuation::Regime& regime,
                              const continuation::Evaluation& out) const override;
  void scale(const Vector& u, const Vector& p, Vector& unknowns, Vector& parameters) const override;

  std::string describe(const continuation::Regime& /*regime*/) const override { return "slip"; }
  int border_count(const continuation::Regime& /*regime*/) const override { return 1; }
  double border(const Vector& u, const Vector& p, const continuation::Regime& regime, int border,
                continuation::Gradient* gradient) const override;
  std::optional<continuation::Regime> regime_beyond(const continuation::Regime& /*regime*/,
                                                    int /*border*/) const override {
    return {};
  }

  /// "eta" and the others.
  std::vector<continuation::Observable> observables() const override;
  void observe(const Vector& u, const Vector& p, const continuation::Regime& regime,
               Vector& values) const override;
  double observe(const Vector& u, const Vector& p, const continuation::Regime& regime, Index which,
                 continuation::Gradient& gradient) const override;

  /// A cycle at (zeta_B, P): one along which -zeta_B rises with R (small), else one along which it falls
  /// (large), or of the size that is wanted; the lowest eta first. Throws std::invalid_argument if none is
  /// found, which may be next to a fold, where two are about to meet.
  continuation::Guess guess(double zeta_value, double preload_value, Size size = Size::any) const;

  /// What it was made of.
  const FrictionSystem& system() const { return system_; }

 private:
  FrictionSystem system_;
  double zeta_scale_ = 0;
};

}  // namespace arcslip::problems
