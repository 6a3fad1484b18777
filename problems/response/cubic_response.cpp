#include "arcslip/problems/response/cubic_response.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace arcslip::problems {

double CubicResponse::spring(const Vector& u) const {
  return 0.75 * system_.cubic_stiffness * std::exp(2 * u(1));
}

bool CubicResponse::evaluate(const Vector& u, const Vector& p, const continuation::Regime& regime,
                             const continuation::Evaluation& out) const {
  if (!has_value(p)) return false;
  const auto [base, damper, threshold, log_ratio, law, force] = state(u(0), p, regime);
  const BaseAmplitude amplitude = base_amplitude(system_, damper, law, threshold);
  const double kappa = spring(u);
  const Complex q = 1.0 + force * damper.compliance;
  const Complex sprung = 1.0 + kappa * base.compliance;
  const Complex closed = q * sprung + force * base.compliance;

  if (out.residual != nullptr) {
    *out.residual << u(1) - u(0) - std::log(amplitude.over_R),
        u(0) + 0.5 * std::log(std::norm(closed) / std::norm(base.free));
  }
  if (out.jacobian == nullptr && out.parameter_jacobian == nullptr) return true;
  const Complex gain = std::conj(closed) / std::norm(closed);
  const Complex by_phi = system_.contact_stiffness * (damper.compliance * sprung + base.compliance);
  const double by_ratio = std::real(gain * by_phi * law.phi_log);
  if (out.jacobian != nullptr) {
    *out.jacobian << -amplitude.by_log_R, 1,  //
        1 + by_ratio, std::real(gain * q * base.compliance) * 2 * kappa;
  }
  if (out.parameter_jacobian != nullptr) {
    const Complex closed_eta =
        force * damper.compliance_eta * sprung + (q * kappa + force) * base.compliance_eta;
    *out.parameter_jacobian << -amplitude.by_eta, -amplitude.by_preload,
        std::real(gain * closed_eta) - log_free_by_eta(base) - by_ratio * threshold.by_eta,
        -by_ratio * threshold.by_preload;
  }
  return true;
}

ComplexVector CubicResponse::motions(const Vector& u, const Vector& p,
                                     const continuation::Regime& regime) const {
  const State at = state(u(0), p, regime);
  const Complex c_B = at.base.compliance;
  const Complex q = 1.0 + at.force * at.damper.compliance;
  const Complex r = -at.base.free / (q * (1.0 + spring(u) * c_B) + at.force * c_B);
  return Eigen::Vector2cd(r, -q * r);
}

void CubicResponse::observe(const Vector& u, const Vector& p, const continuation::Regime& regime,
                            Vector& values) const {
  observe_motion(state(u(0), p, regime), u(0), motions(u, p, regime)(0), p, regime, values);
}

double CubicResponse::observe(const Vector& u, const Vector& /*p*/, const continuation::Regime& /*regime*/,
                              Index /*which*/, continuation::Gradient& gradient) const {
  const double value = std::exp(u(1));
  gradient.unknowns << 0, value;
  gradient.parameters.setZero();
  return value;
}

/// A value of rho below that of every sticking solution: half of |y_0| exceeds both parts of
/// R |1 + k c + 3/4 k_3 (R |q|)^2 q c_B|.
double CubicResponse::log_lower_bound(const Vector& p) const {
  const ContactResponse base = system_.base.at(p(eta));
  const Complex damper = system_.damper.at(p(eta)).compliance;
  const double k = system_.contact_stiffness;
  const Complex q = 1.0 + k * damper;
  const double half = 0.5 * std::abs(base.free);
  const double linear = std::abs(1.0 + k * (base.compliance + damper));
  const double cubic =
      0.75 * std::abs(system_.cubic_stiffness) * std::norm(q) * std::abs(q * base.compliance);
  return std::min(std::log(half / linear), std::log(half / cubic) / 3);
}

continuation::Guess CubicResponse::guess(double eta_value, double preload_value) const {
  continuation::Guess guess{Vector(2), Vector(2), stick};
  guess.parameters << eta_value, preload_value;
  if (!has_value(guess.parameters))
    throw std::invalid_argument("CubicResponse: eta and the preload must be positive");
  const double threshold = log_threshold(guess.parameters).value;
  Vector residual(2);
  Matrix slopes(2, 2);
  // The first equation gives lambda, the second is left: one function of rho.
  const auto g = [&](double rho) -> ValueAndSlope {
    guess.unknowns << rho, 0;
    evaluate(guess.unknowns, guess.parameters, guess.regime, {&residual});
    guess.unknowns(1) = -residual(0);
    evaluate(guess.unknowns, guess.parameters, guess.regime, {&residual, &slopes});
    return {residual(1), slopes(1, 0) - slopes(1, 1) * slopes(0, 0)};
  };
  const double lowest = log_lower_bound(guess.parameters);
  std::optional<double> root;
  if (lowest < threshold) root = first_root(g, lowest, threshold);
  if (!root) {
    guess.regime = slip;
    root = first_root(g, threshold, std::numeric_limits<double>::infinity());
  }
  if (!root) throw std::invalid_argument("CubicResponse: the response has no value here");
  g(*root);  // sets both unknowns
  return guess;
}

}  // namespace arcslip::problems
