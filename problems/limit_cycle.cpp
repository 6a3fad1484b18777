#include "arcslip/problems/limit_cycle.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "arcslip/contact.hpp"
#include "arcslip/problems/contact_problem.hpp"
#include "arcslip/zero_between.hpp"

namespace arcslip::problems {

LimitCycle::LimitCycle(FrictionSystem system) : system_(std::move(system)) {
  // A static load's k c_B/(2 pi) is the fold of one mode on a held damper.
  for (const Mode& mode : system_.base.modes()) {
    if (mode.frequency > 0) zeta_scale_ += mode.residue / (mode.frequency * mode.frequency);
  }
  zeta_scale_ = std::min(0.5 * std::numbers::inv_pi * system_.contact_stiffness * zeta_scale_, 1.0);
}

bool LimitCycle::evaluate(const Vector& u, const Vector& p, int /*regime*/,
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

double LimitCycle::border(const Vector& u, const Vector& p, int /*regime*/, int /*border*/,
                          continuation::Gradient* gradient) const {
  const LogThreshold threshold = system_.log_threshold(u(eta), p(preload));
  if (gradient != nullptr) {
    gradient->unknowns << threshold.by_eta, -1;
    gradient->parameters << 0, threshold.by_preload;
  }
  return threshold.value - u(log_R);
}

std::vector<continuation::Observable> LimitCycle::observables() const {
  return {{"eta", true}, {"R", true}, {"S"}, {"R_over_S"}, {"Y", true}, {"U"}, {"dissipated"}};
}

void LimitCycle::observe(const Vector& u, const Vector& p, int /*regime*/, Vector& values) const {
  const double log_ratio = u(log_R) - system_.log_threshold(u(eta), p(preload)).value;
  const Complex motion =
      system_.contact_stiffness * slip_coefficient(log_ratio).phi * system_.damper.at(u(eta)).compliance;
  values.resize(7);
  values(frequency) = u(eta);
  values(R) = std::exp(u(log_R));
  values(S) = system_.slip_threshold(u(eta), p(preload));
  values(R_over_S) = std::exp(log_ratio);
  values(Y) = values(R) * std::abs(1.0 + motion);
  values(U) = values(R) * std::abs(motion);
  values(dissipated) = dissipated_energy(log_ratio);
}

double LimitCycle::observe(const Vector& u, const Vector& p, int /*regime*/, Index which,
                           continuation::Gradient& gradient) const {
  gradient.unknowns.setZero();
  gradient.parameters.setZero();
  if (which == frequency) {
    gradient.unknowns(eta) = 1;
    return u(eta);
  }
  const double amplitude = std::exp(u(log_R));
  if (which == R) {
    gradient.unknowns(log_R) = amplitude;
    return amplitude;
  }
  const LogThreshold threshold = system_.log_threshold(u(eta), p(preload));
  const BaseAmplitude base = base_amplitude(system_, system_.damper.at(u(eta)),
                                            slip_coefficient(u(log_R) - threshold.value), threshold);
  const double value = amplitude * base.over_R;
  gradient.unknowns << value * base.by_eta, value * base.by_log_R;
  gradient.parameters(preload) = value * base.by_preload;
  return value;
}

/// Newton's method for eta and zeta at a given R/S, on k phi + 1/c = 0: of one mode, linear in eta^2 and
/// zeta.
bool LimitCycle::solve(Cycle& cycle) const {
  const Complex force = system_.contact_stiffness * slip_coefficient(cycle.log_ratio).phi;
  for (int iteration = 0; iteration < 50; ++iteration) {
    const DampedCompliance base =
        system_.base.compliance(cycle.eta, cycle.zeta, system_.base_loss_per_zeta, system_.base_loss_fixed);
    const ContactResponse damper = system_.damper.at(cycle.eta);
    const Complex c = base.value + damper.compliance;
    const Complex value = force + 1.0 / c;
    const Complex by_eta = -(base.by_eta + damper.compliance_eta) / (c * c);
    const Complex by_zeta = -base.by_zeta / (c * c);
    const double determinant = std::imag(std::conj(by_eta) * by_zeta);
    const double eta_step = -std::imag(std::conj(value) * by_zeta) / determinant;
    const double zeta_step = -std::imag(std::conj(by_eta) * value) / determinant;
    cycle.eta += eta_step;
    cycle.zeta += zeta_step;
    if (!(cycle.eta > 0) || !std::isfinite(cycle.zeta)) return false;
    if (std::abs(eta_step) <= 1e-13 * cycle.eta &&
        std::abs(zeta_step) <= 1e-13 * (std::abs(cycle.zeta) + 1e-3 * zeta_scale_))
      return true;
  }
  return false;
}

/// Along the cycle that begins at a resonance of the stuck structures.
bool LimitCycle::find(double resonance, double zeta_value, Size size, Cycle& found) const {
  constexpr double step = 0.02;
  const double sign =
      size == Size::small ? 1 : -1;  // zeta falls along small cycles and rises along large ones
  Cycle before{0, resonance, 0};
  if (!solve(before)) return false;
  while (before.log_ratio < std::log(1e12)) {
    Cycle after = before;
    after.log_ratio += step;
    if (!solve(after)) return false;
    if (sign * (before.zeta - zeta_value) >= 0 && sign * (after.zeta - zeta_value) < 0) {
      found = before;
      const auto difference = [&](double log_ratio) {
        found.log_ratio = log_ratio;
        return solve(found) ? found.zeta - zeta_value : std::numeric_limits<double>::quiet_NaN();
      };
      found.log_ratio = zero_between(difference, before.log_ratio, after.log_ratio, before.zeta - zeta_value,
                                     after.zeta - zeta_value, 48);
      return solve(found);
    }
    before = after;
  }
  return false;
}

continuation::Guess LimitCycle::guess(double zeta_value, double preload_value, Size size) const {
  const double k = system_.contact_stiffness;
  for (const double resonance : joined_frequencies({&system_.base, &system_.damper}, k)) {
    Cycle cycle{};
    if (!find(resonance, zeta_value, size, cycle) || !system_.is_loaded(cycle.eta, preload_value)) continue;
    continuation::Guess guess{Vector(2), Vector(2), 0};
    guess.unknowns << cycle.eta, cycle.log_ratio + system_.log_threshold(cycle.eta, preload_value).value;
    guess.parameters << zeta_value, preload_value;
    return guess;
  }
  throw std::invalid_argument("LimitCycle: there is no cycle of this size at this zeta_B");
}

}  // namespace arcslip::problems
