#pragma once

// What the forced problems of one friction contact and one harmonic share: the parameters eta and P, the
// regimes stick (R <= S, phi = 1) and slip with the border ln(R/S) = 0 between them, the slip threshold
//
//   S(eta, P) = (P + P_2 eta^2) K*/K_FD                                            [paper (13) where P_2 = 0]
//
// and the motions on both sides of the contact, y of the base and u of the damper, r = u - y:
//
//   y = -r q,   u = -r k phi c_D,   q = 1 + k phi c_D.

#include <functional>
#include <optional>

#include "arcslip/assembly/system.hpp"
#include "arcslip/continuation/path/trace.hpp"
#include "arcslip/continuation/problem/problem.hpp"
#include "arcslip/elements/contact.hpp"

namespace arcslip::problems {

/// Y/R = |q| and the derivatives of ln Y as a function of (ln R, eta, P).
struct BaseAmplitude {
  double over_R;      ///< Y/R
  double by_log_R;    ///< d ln Y/d ln R
  double by_eta;      ///< d ln Y/d eta
  double by_preload;  ///< d ln Y/dP
};

/// Of one contact's law and threshold; the base itself does not count.
BaseAmplitude base_amplitude(const FrictionSystem& system, const ContactResponse& damper,
                             const HarmonicCoefficient& law, const LogThreshold& threshold);

/// Phase of a motion behind the excitation, in (-pi, pi].
double lag(Complex z);

/// The observable that such a phase is.
continuation::Observable angle(const std::string& name);

/// d ln|y_0|/deta.
inline double log_free_by_eta(const ContactResponse& base) {
  return std::real(base.free_eta * std::conj(base.free)) / std::norm(base.free);
}

/// Value and slope of a function of one variable.
struct ValueAndSlope {
  double value;  ///< of the function
  double slope;  ///< its derivative
};

/// The first root from `from` to `to` of a function that is negative below it, to rounding. It is searched in
/// steps of 0.05, and at the maximum within a step that begins rising and ends falling: two roots are missed
/// only where the function has two maxima in one step. None if there is no root, or no value on the way.
std::optional<double> first_root(const std::function<ValueAndSlope(double)>& function, double from,
                                 double to);

/// The first of the unknowns is rho = ln R.
class ContactProblem : public continuation::Problem {
 public:
  /// Positions of eta and P.
  enum Parameter : Index { eta, preload };
  /// States of the one switch.
  enum ContactState : int { stick, slip };
  /// Observables in this order; amplitudes and phases as in the columns of branches.csv.
  enum Quantity : Index { R, S, R_over_S, Y, U, beta, alpha, psi, dissipated, T_max, slip_part, told };

  /// The system is kept whole.
  explicit ContactProblem(FrictionSystem system) : system_(std::move(system)) {}

  std::vector<std::string> parameter_names() const override { return {"eta", "P"}; }
  void scale(const Vector& u, const Vector& p, Vector& unknowns, Vector& parameters) const override;

  Index switch_count() const override { return 1; }
  std::string describe(const continuation::Regime& regime) const override {
    return regime[0] == stick ? "stick" : "slip";
  }
  int border_count(const continuation::Regime& /*regime*/) const override { return 1; }
  double border(const Vector& u, const Vector& p, const continuation::Regime& regime, int border,
                continuation::Gradient* gradient) const override;
  std::optional<continuation::Regime> regime_beyond(const continuation::Regime& regime,
                                                    int /*border*/) const override {
    return continuation::Regime(regime[0] == stick ? slip : stick);
  }

  /// Of them Y has a gradient.
  std::vector<continuation::Observable> observables() const override;

  /// Resonances of base, damper and the stuck pair, and the stuck damper's antiresonances, in eta.
  std::vector<double> landmarks(Index parameter, double from, double to) const override;

  /// The first harmonics of the coordinates that HarmonicResponse has of the same system.
  virtual ComplexVector motions(const Vector& u, const Vector& p,
                                const continuation::Regime& regime) const = 0;

  /// What it was made of.
  const FrictionSystem& system() const { return system_; }

 protected:
  /// Of the parameters: ln S, and whether there is a response.
  LogThreshold log_threshold(const Vector& p) const { return system_.log_threshold(p(eta), p(preload)); }
  bool has_value(const Vector& p) const { return p(eta) > 0 && system_.is_loaded(p(eta), p(preload)); }

  /// phi in a regime.
  static HarmonicCoefficient coefficient(double log_ratio, const continuation::Regime& regime) {
    return regime[0] == stick ? HarmonicCoefficient{{1, 0}, {0, 0}} : slip_coefficient(log_ratio);
  }

  /// What the response equations consist of, at one point.
  struct State {
    ContactResponse base;     ///< c_B, y_0
    ContactResponse damper;   ///< c_D
    LogThreshold threshold;   ///< ln S
    double log_ratio;         ///< ln(R/S)
    HarmonicCoefficient law;  ///< phi
    Complex force;            ///< k phi
  };

  /// Evaluates all of them.
  State state(double log_R, const Vector& p, const continuation::Regime& regime) const {
    const LogThreshold threshold = log_threshold(p);
    const double log_ratio = log_R - threshold.value;
    const HarmonicCoefficient law = coefficient(log_ratio, regime);
    return {system_.base.at(p(eta)),
            system_.damper.at(p(eta)),
            threshold,
            log_ratio,
            law,
            system_.contact_stiffness * law.phi};
  }

  /// All observables, where r is the phasor of the relative displacement, known but for rounding.
  void observe_motion(const State& at, double log_R, Complex r, const Vector& p,
                      const continuation::Regime& regime, Vector& values) const;

  FrictionSystem system_;  ///< as it was given
};

}  // namespace arcslip::problems
