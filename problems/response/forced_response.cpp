#include "arcslip/problems/response/forced_response.hpp"

#include <cmath>
#include <limits>
#include <stdexcept>

namespace arcslip::problems {

bool ForcedResponse::evaluate(const Vector& u, const Vector& p, int regime,
                              const continuation::Evaluation& out) const {
  if (!has_value(p)) return false;
  const auto [base, damper, threshold, log_ratio, law, force] = state(u(0), p, regime);
  const Complex c = base.compliance + damper.compliance;
  const Complex closed = 1.0 + force * c;

  if (out.residual != nullptr)
    (*out.residual)(0) = u(0) + 0.5 * std::log(std::norm(closed) / std::norm(base.free));
  if (out.jacobian == nullptr && out.parameter_jacobian == nullptr) return true;
  const Complex gain = system_.contact_stiffness * std::conj(closed) / std::norm(closed);
  const double by_ratio = std::real(gain * c * law.phi_log);  // dg/d ln(R/S) through phi
  if (out.jacobian != nullptr) (*out.jacobian)(0, 0) = 1 + by_ratio;
  if (out.parameter_jacobian != nullptr) {
    const Complex c_eta = base.compliance_eta + damper.compliance_eta;
    (*out.parameter_jacobian)(0, eta) =
        std::real(gain * law.phi * c_eta) - log_free_by_eta(base) - by_ratio * threshold.by_eta;
    (*out.parameter_jacobian)(0, preload) = -by_ratio * threshold.by_preload;
  }
  return true;
}

std::vector<continuation::Observable> ForcedResponse::observables() const {
  std::vector<continuation::Observable> all = ContactProblem::observables();
  for (const ContactOutput& output : system_.outputs) all.push_back({output.name});
  return all;
}

Complex ForcedResponse::motion(const State& at) {
  return -at.base.free / (1.0 + at.force * (at.base.compliance + at.damper.compliance));
}

void ForcedResponse::observe(const Vector& u, const Vector& p, int regime, Vector& values) const {
  const State at = state(u(0), p, regime);
  const Complex r = motion(at);
  observe_motion(at, u(0), r, p, regime, values);
  const auto count = values.size();
  values.conservativeResize(count + std::ssize(system_.outputs));
  const ContactVector force = ContactVector::Constant(1, at.force * r);
  for (std::size_t i = 0; i < system_.outputs.size(); ++i)
    values(count + static_cast<Index>(i)) =
        system_.outputs[i].amplitude(p(eta), system_.outputs[i].on_base ? force : -force);
}

double ForcedResponse::observe(const Vector& u, const Vector& p, int regime, Index /*which*/,
                               continuation::Gradient& gradient) const {
  const LogThreshold threshold = log_threshold(p);
  const BaseAmplitude amplitude = base_amplitude(system_, system_.damper.at(p(eta)),
                                                 coefficient(u(0) - threshold.value, regime), threshold);
  const double value = std::exp(u(0)) * amplitude.over_R;
  gradient.unknowns(0) = value * amplitude.by_log_R;
  gradient.parameters(eta) = value * amplitude.by_eta;
  gradient.parameters(preload) = value * amplitude.by_preload;
  return value;
}

continuation::Guess ForcedResponse::guess(double eta_value, double preload_value) const {
  continuation::Guess guess{Vector(1), Vector(2), stick};
  guess.parameters << eta_value, preload_value;
  if (!has_value(guess.parameters))
    throw std::invalid_argument("ForcedResponse: eta and the preload must be positive");
  const double threshold = log_threshold(guess.parameters).value;
  Vector residual(1);
  Matrix slope(1, 1);
  const auto g = [&](double rho) -> ValueAndSlope {
    guess.unknowns(0) = rho;
    evaluate(guess.unknowns, guess.parameters, guess.regime, {&residual, &slope});
    return {residual(0), slope(0, 0)};
  };
  const double stuck = -g(0).value;  // g = rho + const in stick
  guess.unknowns(0) = stuck;
  if (stuck <= threshold) return guess;

  guess.regime = slip;
  const auto root = first_root(g, threshold, std::numeric_limits<double>::infinity());
  if (!root) throw std::invalid_argument("ForcedResponse: the response has no value here");
  guess.unknowns(0) = *root;
  return guess;
}

}  // namespace arcslip::problems
