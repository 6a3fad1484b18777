#include "arcslip/problems/forced_response.hpp"

#include <algorithm>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <numbers>

#include "arcslip/contact.hpp"

namespace arcslip::problems {
namespace {

HarmonicCoefficient coefficient(double log_ratio, int regime) {
  if (regime == ForcedResponse::stick) return {{1, 0}, {0, 0}};
  return slip_coefficient(log_ratio);
}

/// Phase behind the excitation in (-pi, pi].
double lag(Complex z) {
  const double angle = -std::arg(z);
  return angle <= -std::numbers::pi ? std::numbers::pi : angle;
}

}  // namespace

double ForcedResponse::log_threshold(double preload_value) const {
  return std::log(preload_value * system_.slip_per_preload);
}

bool ForcedResponse::evaluate(const Vector& u, const Vector& p, int regime,
                              const continuation::Evaluation& out) const {
  if (!(p(eta) > 0) || !(p(preload) > 0)) return false;
  const ContactResponse base = system_.base.at(p(eta));
  const ContactResponse damper = system_.damper.at(p(eta));
  const HarmonicCoefficient law = coefficient(u(0) - log_threshold(p(preload)), regime);
  const double k = system_.contact_stiffness;
  const Complex c = base.compliance + damper.compliance;
  const Complex closed = 1.0 + k * law.phi * c;

  if (out.residual != nullptr)
    (*out.residual)(0) = u(0) + 0.5 * std::log(std::norm(closed) / std::norm(base.free));
  if (out.jacobian == nullptr && out.parameter_jacobian == nullptr) return true;
  const Complex gain = k * std::conj(closed) / std::norm(closed);
  const double by_ratio = std::real(gain * c * law.phi_log);  // dg/d ln(R/S) through phi
  if (out.jacobian != nullptr) (*out.jacobian)(0, 0) = 1 + by_ratio;
  if (out.parameter_jacobian != nullptr) {
    const Complex c_eta = base.compliance_eta + damper.compliance_eta;
    const double free_eta = std::real(base.free_eta * std::conj(base.free)) / std::norm(base.free);
    (*out.parameter_jacobian)(0, eta) = std::real(gain * law.phi * c_eta) - free_eta;
    (*out.parameter_jacobian)(0, preload) = -by_ratio / p(preload);
  }
  return true;
}

void ForcedResponse::scale(const Vector& /*u*/, const Vector& p, Vector& unknowns, Vector& parameters) const {
  unknowns(0) = 1;
  parameters = p;
}

double ForcedResponse::border(const Vector& u, const Vector& p, int regime, int /*border*/,
                              continuation::Gradient* gradient) const {
  const double sign = regime == stick ? 1 : -1;
  if (gradient != nullptr) {
    gradient->unknowns(0) = sign;
    gradient->parameters(eta) = 0;
    gradient->parameters(preload) = -sign / p(preload);
  }
  return sign * (u(0) - log_threshold(p(preload)));
}

std::vector<continuation::Observable> ForcedResponse::observables() const {
  return {{"R"}, {"S"}, {"R_over_S"}, {"Y", true}, {"U"}, {"beta"}, {"alpha"}, {"psi"}, {"dissipated"}};
}

void ForcedResponse::observe(const Vector& u, const Vector& p, int regime, Vector& values) const {
  const ContactResponse base = system_.base.at(p(eta));
  const ContactResponse damper = system_.damper.at(p(eta));
  const double log_ratio = u(0) - log_threshold(p(preload));
  const Complex force = system_.contact_stiffness * coefficient(log_ratio, regime).phi;  // k phi
  const Complex r = -base.free / (1.0 + force * (base.compliance + damper.compliance));
  const Complex y = -r * (1.0 + force * damper.compliance);
  const Complex motion = -r * force * damper.compliance;  // u of the damper
  values.resize(9);
  values(R) = std::exp(u(0));
  values(S) = p(preload) * system_.slip_per_preload;
  values(R_over_S) = std::exp(log_ratio);
  values(Y) = values(R) * std::abs(y / r);
  values(U) = values(R) * std::abs(motion / r);
  values(beta) = lag(y);
  values(alpha) = lag(motion);
  values(psi) = lag(r);
  values(dissipated) = regime == slip ? dissipated_energy(log_ratio) : 0;
}

double ForcedResponse::observe(const Vector& u, const Vector& p, int regime, Index /*which*/,
                               continuation::Gradient& gradient) const {
  const ContactResponse damper = system_.damper.at(p(eta));
  const HarmonicCoefficient law = coefficient(u(0) - log_threshold(p(preload)), regime);
  const double k = system_.contact_stiffness;
  const Complex closed = 1.0 + k * law.phi * damper.compliance;  // Y = R |1 + k phi c_D|
  const double value = std::exp(u(0)) * std::sqrt(std::norm(closed));
  const Complex gain = k * std::conj(closed) / std::norm(closed);
  const double by_ratio = std::real(gain * law.phi_log * damper.compliance);
  gradient.unknowns(0) = value * (1 + by_ratio);
  gradient.parameters(eta) = value * std::real(gain * law.phi * damper.compliance_eta);
  gradient.parameters(preload) = -value * by_ratio / p(preload);
  return value;
}

std::vector<double> ForcedResponse::landmarks(Index parameter, double from, double to) const {
  if (parameter != eta) return {};
  const double k = system_.contact_stiffness;
  std::vector<double> values;
  for (const Mode& mode : system_.base.modes()) values.push_back(mode.frequency);
  for (const Mode& mode : system_.damper.modes()) values.push_back(mode.frequency);
  for (const double value : joined_frequencies({&system_.base, &system_.damper}, k)) values.push_back(value);
  for (const double value : joined_frequencies({&system_.damper}, k)) values.push_back(value);
  std::erase_if(values, [&](double value) { return !(value > from && value < to); });
  return values;
}

continuation::Guess ForcedResponse::guess(double eta_value, double preload_value) const {
  continuation::Guess guess{Vector(1), Vector(2), stick};
  guess.parameters << eta_value, preload_value;
  const double threshold = log_threshold(preload_value);
  Vector residual(1);
  const auto g = [&](double rho, int regime) {
    guess.unknowns(0) = rho;
    evaluate(guess.unknowns, guess.parameters, regime, {&residual});
    return residual(0);
  };
  const double stuck = -g(0, stick);  // g = rho + const in stick
  guess.unknowns(0) = stuck;
  if (stuck <= threshold) return guess;

  guess.regime = slip;
  double high = threshold + 1;
  while (g(high, slip) < 0) high += high - threshold;  // g -> rho - ln|y_0|
  std::uintmax_t iterations = 200;
  const auto [a, b] =
      boost::math::tools::toms748_solve([&](double rho) { return g(rho, slip); }, threshold, high,
                                        boost::math::tools::eps_tolerance<double>(48), iterations);
  guess.unknowns(0) = 0.5 * (a + b);
  return guess;
}

}  // namespace arcslip::problems
