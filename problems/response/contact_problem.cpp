#include "arcslip/problems/response/contact_problem.hpp"

#include <algorithm>
#include <cmath>

#include "arcslip/zero_between.hpp"

namespace arcslip::problems {
namespace {

template <class Function>
double root_between(const Function& function, double a, double b) {
  return arcslip::zero_between(function, a, b, function(a), function(b), 48);
}

}  // namespace

double lag(Complex z) {
  const double angle = -std::arg(z);
  return angle <= -pi ? pi : angle;
}

continuation::Observable angle(const std::string& name) {
  return {.name = name, .has_gradient = true, .scale = 1, .period = two_pi};
}

BaseAmplitude base_amplitude(const FrictionSystem& system, const ContactResponse& damper,
                             const HarmonicCoefficient& law, const LogThreshold& threshold) {
  const double k = system.contact_stiffness;
  const Complex q = 1.0 + k * law.phi * damper.compliance;
  const Complex gain = k * std::conj(q) / std::norm(q);
  const double by_ratio = std::real(gain * law.phi_log * damper.compliance);
  return {std::sqrt(std::norm(q)), 1 + by_ratio,
          std::real(gain * law.phi * damper.compliance_eta) - by_ratio * threshold.by_eta,
          -by_ratio * threshold.by_preload};
}

std::optional<double> first_root(const std::function<ValueAndSlope(double)>& function, double from,
                                 double to) {
  constexpr double step = 0.05;
  const auto value = [&](double x) { return function(x).value; };
  const auto slope = [&](double x) { return function(x).slope; };
  double a = from;
  ValueAndSlope at_a = function(a);
  if (at_a.value >= 0) return from;
  while (a < to) {
    const double b = std::min(a + step, to);
    const ValueAndSlope at_b = function(b);
    if (!std::isfinite(at_b.value)) return std::nullopt;
    if (at_b.value >= 0) return root_between(value, a, b);
    if (at_a.slope > 0 && at_b.slope < 0) {
      const double top = root_between(slope, a, b);
      if (value(top) >= 0) return root_between(value, a, top);
    }
    a = b;
    at_a = at_b;
  }
  return std::nullopt;
}

void ContactProblem::scale(const Vector& /*u*/, const Vector& p, Vector& unknowns, Vector& parameters) const {
  unknowns.setOnes();
  parameters = p;
}

double ContactProblem::border(const Vector& u, const Vector& p, const continuation::Regime& regime,
                              int /*border*/, continuation::Gradient* gradient) const {
  const double sign = regime[0] == stick ? 1 : -1;
  const LogThreshold threshold = log_threshold(p);
  if (gradient != nullptr) {
    gradient->unknowns.setZero();
    gradient->unknowns(0) = sign;
    gradient->parameters(eta) = -sign * threshold.by_eta;
    gradient->parameters(preload) = -sign * threshold.by_preload;
  }
  return sign * (u(0) - threshold.value);
}

std::vector<continuation::Observable> ContactProblem::observables() const {
  return {{"R"},     {"S"},   {"R_over_S"},   {"Y", true}, {"U"},   {"beta"},
          {"alpha"}, {"psi"}, {"dissipated"}, {"T_max"},   {"slip"}};
}

void ContactProblem::observe_motion(const State& at, double log_R, Complex r, const Vector& p,
                                    const continuation::Regime& regime, Vector& values) const {
  const Complex y = -r * (1.0 + at.force * at.damper.compliance);
  const Complex motion = -r * at.force * at.damper.compliance;  // u of the damper
  values.resize(told);
  values(R) = std::exp(log_R);
  values(S) = system_.slip_threshold(p(eta), p(preload));
  values(R_over_S) = std::exp(at.log_ratio);
  values(Y) = values(R) * std::abs(y / r);
  values(U) = values(R) * std::abs(motion / r);
  values(beta) = lag(y);
  values(alpha) = lag(motion);
  values(psi) = lag(r);
  const bool slips = regime[0] == slip;
  values(dissipated) = slips ? dissipated_energy(at.log_ratio) : 0;
  values(T_max) = system_.contact_stiffness * values(slips ? S : R);
  values(slip_part) = slips ? slip_fraction(at.log_ratio).value : 0;
}

std::vector<double> ContactProblem::landmarks(Index parameter, double from, double to) const {
  if (parameter != eta) return {};
  const double k = system_.contact_stiffness;
  std::vector<double> values;
  for (const Mode& mode : system_.base.modes())
    values.push_back(std::sqrt(mode.influence.square(mode.frequency)));
  for (const Mode& mode : system_.damper.modes()) values.push_back(mode.frequency);
  for (const double value : joined_frequencies({&system_.base, &system_.damper}, k)) values.push_back(value);
  for (const double value : joined_frequencies({&system_.damper}, k)) values.push_back(value);
  std::erase_if(values, [&](double value) { return !(value > from && value < to); });
  return values;
}

}  // namespace arcslip::problems
