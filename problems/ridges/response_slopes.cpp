#include "arcslip/problems/ridges/response_slopes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "arcslip/problems/response/contact_problem.hpp"

namespace arcslip::problems {

ResponseSlopes::ResponseSlopes(const FrictionSystem& system, double eta)
    : eta_(eta), k_(system.contact_stiffness), base_(system.base.at(eta)), damper_(system.damper.at(eta)) {}

ResponseSlopes::ResponseSlopes(const FrictionSystem& system, double eta, double preload, double log_R,
                               bool slip)
    : ResponseSlopes(system, eta) {
  set(preload, system.log_threshold(eta, preload), log_R, slip);
}

void ResponseSlopes::set(double preload, const LogThreshold& threshold, double log_R, bool slip) {
  preload_ = preload;
  threshold_ = threshold;
  log_R_ = log_R;
  const HarmonicCoefficient law =
      slip ? slip_coefficient(log_R - threshold_.value) : HarmonicCoefficient{{1, 0}, {0, 0}};
  phi_ = law.phi;
  phi_log_ = law.phi_log;
  log_Y_ = log_R + 0.5 * std::log(std::norm(1.0 + k_ * phi_ * damper_.compliance));
}

ResponseSlopes ResponseSlopes::on_border(const FrictionSystem& system, double eta) {
  ResponseSlopes at(system, eta);
  const Complex q = 1.0 + at.k_ * (at.base_.compliance + at.damper_.compliance);
  const double log_R = 0.5 * std::log(std::norm(at.base_.free) / std::norm(q));
  const double pressed = std::exp(log_R) / system.slip_per_preload;  // P + P_2 eta^2
  const LogThreshold threshold{log_R, 2 * system.preload_growth * eta / pressed, 1 / pressed};
  at.set(pressed - system.preload_growth * eta * eta, threshold, log_R, false);
  return at;
}

/// g grows with R, so that its zero lies between any two places of opposite signs.
ResponseSlopes ResponseSlopes::in_slip(const FrictionSystem& system, double eta, double preload,
                                       double near) {
  constexpr double settled = 1e-9;  // of a step, behind which far less is left
  constexpr double on_border = 1e-15;
  ResponseSlopes at(system, eta);
  const LogThreshold threshold = system.log_threshold(eta, preload);
  const Complex kc = at.k_ * (at.base_.compliance + at.damper_.compliance);
  const double log_free = 0.5 * std::log(std::norm(at.base_.free));
  double low = 0;
  double high = std::numeric_limits<double>::infinity();
  double log_ratio = near;
  constexpr int most = 200;
  for (int i = 0; i < most; ++i) {
    const HarmonicCoefficient law = slip_coefficient(log_ratio);
    const Complex q = 1.0 + law.phi * kc;
    const double g = threshold.value + log_ratio + 0.5 * std::log(std::norm(q)) - log_free;
    (g > 0 ? high : low) = log_ratio;
    const double step = -g / (1 + std::real(law.phi_log * std::conj(q) * kc) / std::norm(q));
    double next = log_ratio + step;
    if (std::abs(step) <= settled * (1 + log_ratio) || high <= on_border) {
      at.set(preload, threshold, threshold.value + std::max(0.0, next), true);
      return at;
    }
    if (!(next > low && next < high)) next = std::isfinite(high) ? 0.5 * (low + high) : log_ratio + 1;
    log_ratio = next;
  }
  throw std::runtime_error(fmt::format("no slipping response at eta = {}, P = {}", eta, preload));
}

ResponseSlopes ResponseSlopes::slipping() const {
  ResponseSlopes at = *this;
  at.set(preload_, threshold_, log_R_, true);
  return at;
}

AmplitudeSlopes ResponseSlopes::slopes(const Change& change) const {
  const Complex c = base_.compliance + damper_.compliance;
  const Complex q = 1.0 + k_ * phi_ * c;
  const Complex q_damper = 1.0 + k_ * phi_ * damper_.compliance;
  const Complex gain = k_ * std::conj(q) / std::norm(q);
  const Complex damper_gain = k_ * std::conj(q_damper) / std::norm(q_damper);
  const double by_ratio = std::real(gain * phi_log_ * c);
  AmplitudeSlopes slopes{};
  slopes.log_R = (change.log_free - std::real(gain * phi_ * (change.base + change.damper)) +
                  by_ratio * change.log_threshold) /
                 (1 + by_ratio);
  slopes.log_ratio = slopes.log_R - change.log_threshold;
  slopes.log_Y =
      slopes.log_R +
      std::real(damper_gain * (phi_ * change.damper + slopes.log_ratio * phi_log_ * damper_.compliance));
  return slopes;
}

ResponseSlopes::Change ResponseSlopes::along_eta() const {
  return {base_.compliance_eta, damper_.compliance_eta, log_free_by_eta(base_), threshold_.by_eta};
}

AmplitudeSlopes ResponseSlopes::by_eta() const { return slopes(along_eta()); }

template <class SlopeOf>
PeakSensitivity ResponseSlopes::all(const SlopeOf& slope_of) const {
  PeakSensitivity result;
  result.preload = slope_of(Change{{}, {}, 0, preload_ * threshold_.by_preload});
  result.friction = slope_of(Change{{}, {}, 0, 1});
  result.force = slope_of(Change{{}, {}, 1, 0});
  // K* = gamma^2 M*: c_B = h(eta/gamma)/(M* gamma^2), y_0 = F g(eta/gamma), S = P K*/K_FD.
  result.mass_ratio = slope_of(Change{-base_.compliance, {}, 0, 1});
  result.frequency_ratio = slope_of(
      Change{-2.0 * base_.compliance - eta_ * base_.compliance_eta, {}, -eta_ * log_free_by_eta(base_), 2});
  return result;
}

PeakSensitivity ResponseSlopes::sensitivity() const {
  return all([&](const Change& change) { return slopes(change).log_Y; });
}

PeakSensitivity ResponseSlopes::corner_sensitivity() const {
  const AmplitudeSlopes along = by_eta();
  return all([&](const Change& change) {
    const AmplitudeSlopes at_fixed_eta = slopes(change);
    return at_fixed_eta.log_Y - along.log_Y * at_fixed_eta.log_ratio / along.log_ratio;
  });
}

}  // namespace arcslip::problems
