#include "arcslip/elements/element.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace arcslip {

void ElementForce::set_linear(double stiffness, const HarmonicVector& x, bool derivatives) {
  const Index count = x.size();
  harmonics = stiffness * x;
  by_setting.resize(0);
  energy = 0;
  if (!derivatives) return;
  linear.setZero(count, count);
  linear.diagonal().setConstant(stiffness);
  conjugate.setZero(count, count);
  by_log_load.setZero(count);
}

void ElementForce::scale(double factor, bool derivatives) {
  harmonics *= factor;
  energy *= factor;
  if (!derivatives) return;
  by_log_load *= factor;
  by_setting *= factor;
  by_eta *= factor;
  linear *= factor;
  conjugate *= factor;
}

void ElementForce::add(const Viscous& viscous, const HarmonicVector& x, bool derivatives) {
  const auto& [damping, eta, periods, orders] = viscous;
  if (derivatives) by_eta.setZero(x.size());
  if (derivatives && damping.first != 0 && by_setting.size() == 0) by_setting.setZero(x.size());
  for (Index a = 0; a < x.size(); ++a) {
    const Complex rate(0, two_pi * orders[static_cast<std::size_t>(a)] / periods);
    const Complex force = damping.value * eta * rate * x(a);
    harmonics(a) += force;
    energy += 0.5 * periods * std::real(force * std::conj(rate * x(a)));  // pi h Im(f conj x)
    if (!derivatives) continue;
    linear(a, a) += damping.value * eta * rate;
    by_eta(a) = damping.value * rate * x(a);
    if (damping.first != 0) by_setting(a) += damping.first * eta * rate * x(a);
  }
}

void ElementForce::add_change(const Viscous& viscous, const HarmonicVector& x, const HarmonicVector& dx,
                              double deta, double setting) {
  const auto& [damping, eta, periods, orders] = viscous;
  by_eta.resize(x.size());
  for (Index a = 0; a < x.size(); ++a) {
    const Complex rate(0, two_pi * orders[static_cast<std::size_t>(a)] / periods);
    const Complex per_eta = damping.value * rate;  // of linear
    const Complex per_setting = damping.first * eta * rate;
    harmonics(a) += per_eta * x(a) * deta;
    linear(a, a) += per_eta * deta + per_setting * setting;
    by_eta(a) = per_eta * dx(a) + damping.first * rate * x(a) * setting;
    if (damping.first != 0) by_setting(a) += per_setting * dx(a) + damping.first * rate * x(a) * deta;
  }
}

void ElementForce::add(const ElementForce& change, double part) {
  harmonics += part * change.harmonics;
  by_log_load += part * change.by_log_load;
  by_setting += part * change.by_setting;
  by_eta += part * change.by_eta;
  linear += part * change.linear;
  conjugate += part * change.conjugate;
}

void ElementForce::add_rate(const ElementForce& ahead, const ElementForce& behind, double step) {
  const auto rate = [step](const auto& one, const auto& other) { return (one - other) / (2 * step); };
  linear += rate(ahead.linear, behind.linear);
  conjugate += rate(ahead.conjugate, behind.conjugate);
  by_log_load += rate(ahead.by_log_load, behind.by_log_load);
  if (ahead.by_setting.size() > 0) by_setting += rate(ahead.by_setting, behind.by_setting);
}

ElementForce Element::change(const ElementForce& at, std::span<const int> orders, const HarmonicVector& x,
                             double load, bool beyond, const Way& way) const {
  ElementForce change;
  change.harmonics =
      at.linear * way.motion + at.conjugate * way.motion.conjugate() + at.by_log_load * way.log_load;
  if (at.by_setting.size() > 0) change.harmonics += at.by_setting * way.setting;
  change.by_setting.setZero(at.by_setting.size());
  change.by_log_load.setZero(x.size());
  change.linear.setZero(x.size(), x.size());
  change.conjugate.setZero(x.size(), x.size());
  if (!(is_linear(beyond) && all_odd(orders))) second(at, orders, x, load, beyond, way, change);
  return change;
}

MotionNumber Element::border(std::span<const int> orders, const HarmonicVector& x, const Swing* known,
                             double load, bool beyond) const {
  const Swing swing = known != nullptr ? *known : Swing::of(orders, x);
  const double amplitude = forgets_mean() ? swing.half() : swing.peak();
  const double limit = threshold(load);
  const double sign = beyond ? -1 : 1;
  const double square = amplitude * amplitude;
  const double sum = square + limit * limit;
  const double slope = sign * 4 * limit * limit / (sum * sum);  // by A^2/2
  MotionNumber border{sign * (square - limit * limit) / sum, HarmonicVector(std::ssize(orders)),
                      -slope * square * threshold_by_log_load(),
                      -slope * square * log_threshold_by_setting()};
  for (Index a = 0; a < border.by_motion.size(); ++a) {
    const int h = orders[static_cast<std::size_t>(a)];
    border.by_motion(a) = slope * amplitude * (forgets_mean() ? swing.half_by(h) : swing.peak_by(h));
  }
  return border;
}

double Element::Way::pace(const HarmonicVector& x, double setting_scale) const {
  const double size = x.norm() > 0 ? x.norm() : 1;
  return std::max({motion.norm() / size, std::abs(log_load), std::abs(setting) / setting_scale});
}

void Element::difference(const Moved& moved, const HarmonicVector& x, const Way& way, double setting_scale,
                         double relative, ElementForce& change) {
  const double pace = way.pace(x, setting_scale);
  if (!(pace > 0)) return;
  const double step = relative / pace;
  ElementForce ahead;
  ElementForce behind;
  moved(x + step * way.motion, step * way.log_load, step * way.setting, ahead);
  moved(x - step * way.motion, -step * way.log_load, -step * way.setting, behind);
  change.add_rate(ahead, behind, step);
}

DisturbedLaw Element::disturbed(std::span<const int> /*orders*/, const HarmonicVector& /*x*/, double /*load*/,
                                bool /*beyond*/) const {
  throw std::logic_error("Element: disturbances are not followed through this memory");
}

VaryingStiffness Element::stiffness_in_time(std::span<const int> /*orders*/,
                                            const HarmonicVector& /*x*/) const {
  throw std::logic_error("Element: what has a memory has no stiffness in time");
}

double cycle_energy(std::span<const int> orders, const Eigen::Ref<const ComplexVector>& force,
                    const Eigen::Ref<const ComplexVector>& x) {
  double sum = 0;
  for (std::size_t a = 0; a < orders.size(); ++a) {
    const auto at = static_cast<Index>(a);
    sum += pi * orders[a] * std::imag(force(at) * std::conj(x(at)));
  }
  return sum;
}

double Element::event(Index /*which*/, std::span<const int> /*orders*/, const HarmonicVector& /*x*/,
                      double /*load*/) const {
  throw std::logic_error("Element: it has no events");
}

double Element::threshold(double /*load*/) const { return std::numeric_limits<double>::infinity(); }

}  // namespace arcslip
