#include "arcslip/elements/circle/circle_element.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "arcslip/elements/circle/circle_readings.hpp"

namespace arcslip {

CircleElement::CircleElement(const Settings& settings, bool closes) : settings_(settings), closes_(closes) {
  if (!(settings.tangential.value > 0 && settings.normal.value >= 0 && settings.friction.value > 0 &&
        settings.reference > 0))
    throw std::invalid_argument(
        "CircleElement: tangential stiffness, friction and reference must be positive, normal stiffness not "
        "negative");
  if (!closes && settings.normal.value != 0)
    throw std::invalid_argument("CircleElement: a normal stiffness needs a closing displacement");
}

double CircleElement::reference_stiffness(Index coordinate) const {
  if (coordinate < 2) return settings_.tangential.value;
  return settings_.normal.value > 0 ? settings_.normal.value : settings_.reference;
}

void CircleElement::force(std::span<const int> orders, const HarmonicVector& x, double load, bool beyond,
                          bool derivatives, ElementForce& out) const {
  force_at(orders, x, load, 0, beyond, derivatives, out);
}

void CircleElement::force_at(std::span<const int> orders, const HarmonicVector& x, double load,
                             double setting, bool beyond, bool derivatives, ElementForce& out) const {
  const Index size = x.size();
  const Index n = std::ssize(orders);
  const PressedSettings settings = settings_.at(load, setting);
  const CircleForce found = circle_force(settings, orders, x, derivatives,
                                         beyond ? PressedArcs::Course::slips : PressedArcs::Course::sticks);
  const Index mean = 2 * n + place_of_mean(orders);
  out.harmonics = found.harmonics.head(size);
  if (mean < size) out.harmonics(mean) -= std::max(0.0, settings.normal_force);
  out.energy = found.energy;
  out.further_slips = found.further_slips;
  out.by_setting.resize(0);
  if (!derivatives) return;
  out.linear = found.linear.topLeftCorner(size, size);
  out.conjugate = found.conjugate.topLeftCorner(size, size);
  std::array<double, PressedForce::settings> by_load{};
  const auto along = [&](const std::array<double, PressedForce::settings>& rates) {
    HarmonicVector sum = HarmonicVector::Zero(size);
    for (std::size_t s = 0; s < rates.size(); ++s) {
      if (rates[s] != 0) sum += rates[s] * found.by[s].head(size);
    }
    if (mean < size && settings.normal_force > 0) sum(mean) -= rates[PressedForce::normal_force];
    return sum;
  };
  by_load[PressedForce::normal_force] = settings_.by_log_load(load, setting);
  out.by_log_load = along(by_load);
  if (settings_.scale() > 0) out.by_setting = along(settings_.rates(load, setting));
}

/// The excess over the root of the mean squares of k_t r, without its mean, and of mu n.
MotionNumber CircleElement::border(std::span<const int> orders, const HarmonicVector& x,
                                   const Swing* /*known*/, double load, bool beyond) const {
  const Index n = std::ssize(orders);
  const PressedSettings settings = settings_.at(load, 0);
  const CircleRoom room = circle_room(settings, orders, x);
  const double k = settings.tangential_stiffness;
  const double mu = settings.friction;
  std::array<double, PressedForce::settings> by{};  // of half the square of that root
  HarmonicVector by_motion = HarmonicVector::Zero(x.size());
  double square = 0;
  for (Index a = 0; a < n; ++a) {
    const bool is_mean = orders[static_cast<std::size_t>(a)] == 0;
    const double share = is_mean ? 1 : 0.5;
    const double slid = is_mean ? 0 : 0.5 * (std::norm(x(a)) + std::norm(x(n + a)));
    square += k * k * slid;
    by[PressedForce::tangential_stiffness] += k * slid;
    if (!is_mean) {
      by_motion(a) = 0.5 * k * k * x(a);
      by_motion(n + a) = 0.5 * k * k * x(n + a);
    }
    const Complex closes = closes_ ? x(2 * n + a) : 0;
    const Complex press = settings.normal_stiffness * closes + (is_mean ? settings.normal_force : 0);
    square += mu * mu * share * std::norm(press);
    by[PressedForce::friction] += mu * share * std::norm(press);
    by[PressedForce::normal_stiffness] += mu * mu * share * std::real(press * std::conj(closes));
    if (is_mean) by[PressedForce::normal_force] += mu * mu * press.real();
    if (closes_) by_motion(2 * n + a) = mu * mu * settings.normal_stiffness * share * press;
  }
  if (place_of_mean(orders) == n) {
    square += mu * mu * settings.normal_force * settings.normal_force;
    by[PressedForce::friction] += mu * settings.normal_force * settings.normal_force;
    by[PressedForce::normal_force] += mu * mu * settings.normal_force;
  }
  MotionNumber border{0, HarmonicVector::Zero(x.size()), 0, 0};
  if (!(square > 0)) return border;
  const double root = std::sqrt(square);
  const double sign = beyond ? -1 : 1;
  border.value = sign * room.excess / root;
  border.by_motion = (sign / root) * room.by_motion - (border.value / square) * by_motion;
  for (std::size_t s = 0; s < by.size(); ++s) {
    const double slope = sign * room.by[s] / root - border.value / square * by[s];
    border.by_setting += slope * settings_.rates(load)[s];
    if (s == PressedForce::normal_force) border.by_log_load = slope * settings_.by_log_load(load, 0);
  }
  return border;
}

std::vector<MotionNumber> CircleElement::read(std::span<const int> orders, const HarmonicVector& x,
                                              double load, bool beyond, bool derivatives) const {
  return PressedElement::told(settings_, circle_readings(settings(load), orders, x, beyond, derivatives),
                              orders, x, load, 2);
}

void CircleElement::second(const ElementForce& /*at*/, std::span<const int> orders, const HarmonicVector& x,
                           double load, bool beyond, const Way& way, ElementForce& change) const {
  const auto moved = [&](const HarmonicVector& motion, double log_load, double setting, ElementForce& out) {
    force_at(orders, motion, load * std::exp(log_load), setting, beyond, true, out);
  };
  const double scale = settings_.scale();
  difference(moved, x, way, scale > 0 ? scale : 1, smooth_step, change);
}

}  // namespace arcslip
