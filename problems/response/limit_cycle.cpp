#include "arcslip/problems/response/limit_cycle.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <tuple>

#include "arcslip/elements/contact.hpp"
#include "arcslip/problems/response/contact_problem.hpp"
#include "arcslip/problems/response/limit_cycle_search.hpp"

namespace arcslip::problems {

LimitCycle::LimitCycle(FrictionSystem system) : system_(std::move(system)) {
  // A static load's k c_B/(2 pi) is the fold of one mode on a held damper.
  for (const Mode& mode : system_.base.modes()) {
    if (mode.frequency > 0) zeta_scale_ += mode.residue / (mode.frequency * mode.frequency);
  }
  zeta_scale_ = std::min(0.5 * std::numbers::inv_pi * system_.contact_stiffness * zeta_scale_, 1.0);
}

bool LimitCycle::evaluate(const Vector& u, const Vector& p, const continuation::Regime& /*regime*/,
                          const continuation::Evaluation& out) const {
  if (!(u(eta) > 0) || !system_.is_loaded(u(eta), p(preload))) return false;
  const DampedCompliance base =
      system_.base.compliance(u(eta), p(zeta), system_.base_loss_per_zeta, system_.base_loss_fixed);
  const ContactResponse damper = system_.damper.at(u(eta));
  const LogThreshold threshold = system_.log_threshold(u(eta), p(preload));
  const HarmonicCoefficient law = slip_coefficient(u(log_R) - threshold.value);
  const double k = system_.contact_stiffness;
  const Complex c = base.value + damper.compliance;
  const Complex by_ratio = k * c * law.phi_log;

  if (out.residual != nullptr) {
    const Complex value = 1.0 + k * law.phi * c;
    *out.residual << value.real(), value.imag();
  }
  if (out.jacobian != nullptr) {
    const Complex by_eta = k * law.phi * (base.by_eta + damper.compliance_eta) - by_ratio * threshold.by_eta;
    *out.jacobian << by_eta.real(), by_ratio.real(), by_eta.imag(), by_ratio.imag();
  }
  if (out.parameter_jacobian != nullptr) {
    const Complex by_zeta = k * law.phi * base.by_zeta;
    const Complex by_preload = -by_ratio * threshold.by_preload;
    *out.parameter_jacobian << by_zeta.real(), by_preload.real(), by_zeta.imag(), by_preload.imag();
  }
  return true;
}

void LimitCycle::scale(const Vector& u, const Vector& p, Vector& unknowns, Vector& parameters) const {
  unknowns << u(eta), 1;
  parameters << std::max(std::abs(p(zeta)), zeta_scale_), p(preload);
}

double LimitCycle::border(const Vector& u, const Vector& p, const continuation::Regime& /*regime*/,
                          int /*border*/, continuation::Gradient* gradient) const {
  const LogThreshold threshold = system_.log_threshold(u(eta), p(preload));
  if (gradient != nullptr) {
    gradient->unknowns << threshold.by_eta, -1;
    gradient->parameters << 0, threshold.by_preload;
  }
  return threshold.value - u(log_R);
}

std::vector<continuation::Observable> LimitCycle::observables() const {
  return {{"eta", true}, {"R", true},          {"S", true},     {"R_over_S", true}, {"Y", true},
          {"U", true},   {"dissipated", true}, {"T_max", true}, {"slip", true}};
}

void LimitCycle::observe(const Vector& u, const Vector& p, const continuation::Regime& /*regime*/,
                         Vector& values) const {
  const double log_ratio = u(log_R) - system_.log_threshold(u(eta), p(preload)).value;
  const Complex motion =
      system_.contact_stiffness * slip_coefficient(log_ratio).phi * system_.damper.at(u(eta)).compliance;
  values.resize(9);
  values(frequency) = u(eta);
  values(R) = std::exp(u(log_R));
  values(S) = system_.slip_threshold(u(eta), p(preload));
  values(R_over_S) = std::exp(log_ratio);
  values(Y) = values(R) * std::abs(1.0 + motion);
  values(U) = values(R) * std::abs(motion);
  values(dissipated) = dissipated_energy(log_ratio);
  values(T_max) = system_.contact_stiffness * values(S);
  values(slip) = slip_fraction(log_ratio).value;
}

double LimitCycle::observe(const Vector& u, const Vector& p, const continuation::Regime& regime, Index which,
                           continuation::Gradient& gradient) const {
  Vector values;
  observe(u, p, regime, values);
  const LogThreshold threshold = system_.log_threshold(u(eta), p(preload));
  const HarmonicCoefficient law = slip_coefficient(u(log_R) - threshold.value);
  const ContactResponse damper = system_.damper.at(u(eta));
  gradient.unknowns.setZero();
  gradient.parameters.setZero();
  // value times a change by ln R and one by ln S, and by eta beside that
  const auto fill = [&](double value, double by_log_R, double by_log_S, double by_eta) {
    gradient.unknowns << value * (by_eta + by_log_S * threshold.by_eta), value * by_log_R;
    gradient.parameters(preload) = value * by_log_S * threshold.by_preload;
  };
  switch (which) {
    case frequency: gradient.unknowns(eta) = 1; break;
    case R: gradient.unknowns(log_R) = values(R); break;
    case S: fill(values(S), 0, 1, 0); break;
    case R_over_S: fill(values(R_over_S), 1, -1, 0); break;
    case dissipated: fill(4 * values(R_over_S), 1, -1, 0); break;
    case T_max: fill(values(T_max), 0, 1, 0); break;
    case slip: fill(slip_fraction(u(log_R) - threshold.value).by_log, 1, -1, 0); break;
    case U: {
      if (values(U) == 0) break;  // a damper that is held
      const double by_ratio = std::real(law.phi_log / law.phi);
      fill(values(U), 1 + by_ratio, -by_ratio, std::real(damper.compliance_eta / damper.compliance));
      break;
    }
    default: {
      const BaseAmplitude base = base_amplitude(system_, damper, law, threshold);
      gradient.unknowns << values(Y) * base.by_eta, values(Y) * base.by_log_R;
      gradient.parameters(preload) = values(Y) * base.by_preload;
    }
  }
  return values(which);
}

continuation::Guess LimitCycle::guess(double zeta_value, double preload_value, Size size) const {
  std::vector<CycleAtZeta> cycles = cycles_at(system_, zeta_value);
  std::erase_if(cycles, [&](const CycleAtZeta& cycle) {
    return (size != Size::any && cycle.is_small != (size == Size::small)) ||
           !system_.is_loaded(cycle.eta, preload_value);
  });
  if (cycles.empty()) {
    const char* kind = size == Size::any ? "" : size == Size::small ? "small " : "large ";
    throw std::invalid_argument(
        fmt::format("LimitCycle: no {}limit cycle was found at zeta_B = {:g}, P = {:g}", kind, zeta_value,
                    preload_value));
  }
  const CycleAtZeta& first =
      *std::min_element(cycles.begin(), cycles.end(), [](const CycleAtZeta& a, const CycleAtZeta& b) {
        return std::tuple(!a.is_small, a.eta, a.log_ratio) < std::tuple(!b.is_small, b.eta, b.log_ratio);
      });
  continuation::Guess guess{Vector(2), Vector(2), 0};
  guess.unknowns << first.eta, first.log_ratio + system_.log_threshold(first.eta, preload_value).value;
  guess.parameters << zeta_value, preload_value;
  return guess;
}

}  // namespace arcslip::problems
