#include "arcslip/problems/response/forced_response.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace arcslip::problems {

namespace {

bool is_passive(const ModalModel& structure) {
  const Loss& loss = structure.loss();
  const auto takes_energy = [](const Mode& mode) {
    return mode.residue >= 0 && mode.influence.damping >= 0 && mode.influence.stiffness.imag() <= 0;
  };
  return loss.viscous >= 0 && loss.structural >= 0 && loss.modal >= 0 && loss.mass >= 0 &&
         std::all_of(structure.modes().begin(), structure.modes().end(), takes_energy);
}

}  // namespace

ForcedResponse::ForcedResponse(FrictionSystem system)
    : ContactProblem(std::move(system)),
      is_passive_(is_passive(system_.base) && is_passive(system_.damper)) {}

bool ForcedResponse::evaluate(const Vector& u, const Vector& p, const continuation::Regime& regime,
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
  for (const Index one : {R, S, R_over_S, Y, U, dissipated, T_max, slip_part})
    all[static_cast<std::size_t>(one)].has_gradient = true;
  for (const Index one : {beta, alpha, psi}) {
    continuation::Observable& phase = all[static_cast<std::size_t>(one)];
    phase = angle(phase.name);
  }
  for (const ContactOutput& output : system_.outputs) all.push_back({output.name, true});
  return all;
}

Complex ForcedResponse::motion(const State& at, double log_R) {
  const Complex r = -at.base.free / (1.0 + at.force * (at.base.compliance + at.damper.compliance));
  return r * (std::exp(log_R) / std::abs(r));
}

void ForcedResponse::observe(const Vector& u, const Vector& p, const continuation::Regime& regime,
                             Vector& values) const {
  const State at = state(u(0), p, regime);
  const Complex r = motion(at, u(0));
  observe_motion(at, u(0), r, p, regime, values);
  const auto count = values.size();
  values.conservativeResize(count + std::ssize(system_.outputs));
  const ContactVector force = ContactVector::Constant(1, at.force * r);
  for (std::size_t i = 0; i < system_.outputs.size(); ++i)
    values(count + static_cast<Index>(i)) =
        system_.outputs[i].amplitude(p(eta), system_.outputs[i].on_base ? force : -force);
}

namespace {

/// What changes as rho, eta and P do.
struct Change {
  Complex by_log_R;
  Complex by_eta;
  Complex by_preload;

  friend Change operator+(const Change& a, const Change& b) {
    return {a.by_log_R + b.by_log_R, a.by_eta + b.by_eta, a.by_preload + b.by_preload};
  }
  friend Change operator*(Complex factor, const Change& change) {
    return {factor * change.by_log_R, factor * change.by_eta, factor * change.by_preload};
  }

  /// Its real part as a gradient.
  void put(continuation::Gradient& gradient) const {
    gradient.unknowns(0) = by_log_R.real();
    gradient.parameters << by_eta.real(), by_preload.real();
  }
};

}  // namespace

double ForcedResponse::observe(const Vector& u, const Vector& p, const continuation::Regime& regime,
                               Index which, continuation::Gradient& gradient) const {
  if (which == Y) return observe_base(u, p, regime, gradient);
  Vector values;
  observe(u, p, regime, values);
  const State at = state(u(0), p, regime);
  const Change log_S{0, at.threshold.by_eta, at.threshold.by_preload};
  const Change log_ratio = Change{1, 0, 0} + -1.0 * log_S;
  const Change force = system_.contact_stiffness * at.law.phi_log * log_ratio;
  const Complex c = at.base.compliance + at.damper.compliance;
  const Complex c_eta = at.base.compliance_eta + at.damper.compliance_eta;
  const Change log_closed = 1.0 / (1.0 + at.force * c) * (c * force + Change{0, at.force * c_eta, 0});
  const Change log_r = Change{0, at.base.free_eta / at.base.free, 0} + -1.0 * log_closed;
  const Complex over_r = at.force * at.damper.compliance;  // -u/r
  const Change by_damper = at.damper.compliance * force + Change{0, at.force * at.damper.compliance_eta, 0};
  const Change log_over_r = over_r == 0.0 ? Change{} : 1.0 / over_r * by_damper;
  const auto of = [&](Complex factor, const Change& change) { (factor * change).put(gradient); };
  constexpr Complex turn(0, 1);  // a lag is -Im of a logarithm
  switch (which) {
    case R: of(values(R), {1, 0, 0}); break;
    case S: of(values(S), log_S); break;
    case R_over_S: of(values(R_over_S), log_ratio); break;
    case U: of(values(U), Change{1, 0, 0} + log_over_r); break;
    case beta: of(turn, log_r + 1.0 / (1.0 + over_r) * by_damper); break;
    case alpha: of(over_r == 0.0 ? 0.0 : turn, log_r + log_over_r); break;
    case psi: of(turn, log_r); break;
    case dissipated: of(regime[0] == slip ? 4 * values(R_over_S) : 0, log_ratio); break;
    case T_max: of(values(T_max), regime[0] == slip ? log_S : Change{1, 0, 0}); break;
    case slip_part: of(regime[0] == slip ? slip_fraction(at.log_ratio).by_log : 0, log_ratio); break;
    default: {
      const ContactOutput& output = system_.outputs[static_cast<std::size_t>(which - told)];
      const ContactReceptance receptance = output.modes.at(p(eta));
      const double side = output.on_base ? 1 : -1;
      const Complex r = motion(at, u(0));
      const Complex pull = side * receptance.compliance(1, 0) * r;
      const Complex by_eta = receptance.free_eta(1) + side * receptance.compliance_eta(1, 0) * at.force * r;
      const Complex z = receptance.free(1) + pull * at.force;
      // Of ln r the unknown gives the real part.
      const Change turned{Complex(1, log_r.by_log_R.imag()), Complex(0, log_r.by_eta.imag()),
                          Complex(0, log_r.by_preload.imag())};
      of(std::conj(z) / std::abs(z), Change{0, by_eta, 0} + pull * (force + at.force * turned));
    }
  }
  return values(which);
}

/// Y.
double ForcedResponse::observe_base(const Vector& u, const Vector& p, const continuation::Regime& regime,
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
