#include "arcslip/elements/pressed/pressed_element.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "arcslip/elements/pressed/pressed_law.hpp"

namespace arcslip {
namespace {

/// Adds a part of a derivative to the rows of one coordinate by those of another.
void put(const HarmonicDerivative& part, Index row, Index column, ElementForce& out) {
  const Index n = part.linear.rows();
  out.linear.block(row * n, column * n, n, n) = part.linear;
  out.conjugate.block(row * n, column * n, n, n) = part.conjugate;
}

}  // namespace

PressedElement::PressedElement(const Settings& settings) : settings_(settings) {
  if (!(settings.tangential.value > 0 && settings.normal.value >= 0 && settings.friction.value >= 0 &&
        settings.reference > 0))
    throw std::invalid_argument(
        "PressedElement: tangential stiffness and reference must be positive, normal stiffness and friction "
        "not negative");
}

double PressedElement::reference_stiffness(Index coordinate) const {
  if (coordinate == 0) return settings_.tangential.value;
  return settings_.normal.value > 0 ? settings_.normal.value : settings_.reference;
}

PressedSettings PressedElement::Settings::at(double load, double setting) const {
  const auto here = [setting](const Jet& number) { return shifted(number, setting).value; };
  return {here(friction), here(tangential), here(normal), here(normal_force) + load * here(normal_per_load)};
}

double PressedElement::Settings::by_log_load(double load, double setting) const {
  return load * shifted(normal_per_load, setting).value;
}

std::array<double, PressedForce::settings> PressedElement::Settings::rates(double load) const {
  return {friction.first, tangential.first, normal.first, normal_force.first + load * normal_per_load.first};
}

bool PressedElement::rests_beyond(double load) const {
  return !(settings_.friction.value > 0 && settings_.at(load, 0).normal_force > 0);
}

void PressedElement::force(std::span<const int> orders, const HarmonicVector& x, double load, bool beyond,
                           bool derivatives, ElementForce& out) const {
  force_at(orders, x, load, 0, beyond, derivatives, out);
}

void PressedElement::force_at(std::span<const int> orders, const HarmonicVector& x, double load,
                              double setting, bool beyond, bool derivatives, ElementForce& out) const {
  const Index n = std::ssize(orders);
  const PressedSettings settings = settings_.at(load, setting);
  const PressedForce found =
      pressed_force(settings, orders, x.head(n), x.tail(n), derivatives, course(beyond));
  const Index mean = n + place_of_mean(orders);
  const double rests = std::max(0.0, settings.normal_force);
  const auto both = [&](const ComplexVector& tangential, const ComplexVector& normal, double rest) {
    HarmonicVector all(2 * n);
    all << tangential, normal;
    all(mean) -= rest;
    return all;
  };
  out.harmonics = both(found.tangential, found.normal, rests);
  out.energy = found.energy;
  out.readings = {found.least_normal, found.greatest_normal, found.slip_fraction, found.apart_fraction};
  out.by_setting.resize(0);
  if (!derivatives) return;
  out.linear.setZero(2 * n, 2 * n);
  out.conjugate.setZero(2 * n, 2 * n);
  put(found.tangential_by_sliding, 0, 0, out);
  put(found.tangential_by_closing, 0, 1, out);
  put(found.normal_by_closing, 1, 1, out);
  const double rests_rate = settings.normal_force > 0 ? 1 : 0;
  const auto by = [&](PressedForce::Setting which) {
    const bool is_force = which == PressedForce::normal_force;
    return both(found.tangential_by[which], found.normal_by[which], is_force ? rests_rate : 0);
  };
  out.by_log_load = settings_.by_log_load(load, setting) * by(PressedForce::normal_force);
  if (!(settings_.scale() > 0)) return;
  const auto rates = settings_.rates(load);
  out.by_setting = rates[PressedForce::friction] * by(PressedForce::friction) +
                   rates[PressedForce::tangential_stiffness] * by(PressedForce::tangential_stiffness) +
                   rates[PressedForce::normal_stiffness] * by(PressedForce::normal_stiffness) +
                   rates[PressedForce::normal_force] * by(PressedForce::normal_force);
}

DisturbedLaw PressedElement::disturbed(std::span<const int> orders, const HarmonicVector& x, double load,
                                       bool beyond) const {
  const Index n = std::ssize(orders);
  const int highest = highest_order(orders);
  const PressedSettings settings = settings_.at(load, 0);
  const PressedArcs arcs(settings, sliding_motion(orders, x.head(n), course(beyond)),
                         PeriodicMotion(orders, x.tail(n), highest), course(beyond));
  return pressed_law(settings, arcs, 2);
}

std::shared_ptr<const Element> PressedElement::alone() const {
  auto same = std::make_shared<PressedElement>(*this);
  same->is_alone_ = true;
  return same;
}

/// W/sqrt(T^2 + B^2) of W = min (k_t r + mu n) - max (k_t r - mu n), T = max (k_t r + mu n) and B = min (k_t
/// r - mu n); where nothing else holds the mean, and A = 0, of the lesser part of W.
MotionNumber PressedElement::border(std::span<const int> orders, const HarmonicVector& x,
                                    const Swing* /*known*/, double load, bool beyond) const {
  const Index n = std::ssize(orders);
  const PressedSettings settings = settings_.at(load, 0);
  const int highest = highest_order(orders);
  const PeriodicMotion slides(orders, x.head(n), highest);
  const PeriodicMotion closes(orders, x.tail(n), highest);
  const PressedArcs course(settings, slides, closes, PressedArcs::Course::sticks);
  const double top = course.highest_high().high;
  const double bottom = course.lowest_low().low;
  const double norm = std::hypot(top, bottom);
  const double sign = beyond ? 1 : -1;
  MotionNumber border{0, HarmonicVector::Zero(2 * n), 0, 0};
  if (!(norm > 0)) return border;
  const double above = course.lowest_high().high;
  const double below = -course.highest_low().low;
  border.value = sign * (is_alone_ ? std::min(above, below) : course.room()) / norm;
  const double k = settings.tangential_stiffness;
  const double mu = settings.friction;
  const Settings& s = settings_;
  const auto add = [&](double angle, double side, double part) {  // of a bound k_t r + side mu n
    for (Index a = 0; a < n; ++a) {
      const Complex turn = std::polar(1.0, -orders[static_cast<std::size_t>(a)] * angle);
      border.by_motion(a) += part * k * turn;
      border.by_motion(n + a) += part * side * mu * settings.normal_stiffness * turn;
    }
    const double closing = closes.value(angle);
    const double press = settings.normal_force + settings.normal_stiffness * closing;
    border.by_log_load += part * side * mu * load * s.normal_per_load.value;
    border.by_setting +=
        part * (s.tangential.first * slides.value(angle) +
                side * (s.friction.first * press + mu * (s.normal.first * closing + s.normal_force.first +
                                                         load * s.normal_per_load.first)));
  };
  if (!is_alone_ || above <= below) add(course.lowest_high().angle, 1, sign / norm);
  if (!is_alone_ || below < above) add(course.highest_low().angle, -1, -sign / norm);
  const double per_norm = border.value / (norm * norm);
  add(course.highest_high().angle, 1, -per_norm * top);
  add(course.lowest_low().angle, -1, -per_norm * bottom);
  return border;
}

double PressedElement::least_press(const PressedSettings& settings, std::span<const int> orders,
                                   const Eigen::Ref<const HarmonicVector>& closing) {
  const PeriodicMotion closes(orders, closing, highest_order(orders));
  double least = closes.value(0);
  for (const double angle : closes.derivative().zeros()) least = std::min(least, closes.value(angle));
  return (settings.normal_force + settings.normal_stiffness * least) /
         (std::abs(settings.normal_force) + settings.normal_stiffness * closing.lpNorm<1>());
}

MotionNumber PressedElement::extreme_press(const Settings& settings, std::span<const int> orders,
                                           const HarmonicVector& x, double load, Index closing,
                                           bool greatest) {
  const Index n = std::ssize(orders);
  const PressedSettings here = settings.at(load, 0);
  MotionNumber found{here.normal_force, HarmonicVector::Zero(x.size()), settings.by_log_load(load, 0), 0};
  const auto rates = settings.rates(load);
  found.by_setting = rates[PressedForce::normal_force];
  if (closing * n < x.size()) {
    const PeriodicMotion closes(orders, x.segment(closing * n, n), highest_order(orders));
    const Swing swing = Swing::at(closes, closes.derivative().zeros());
    const OddMotion::Maximum& place = greatest ? swing.greatest : swing.least;
    found.value += here.normal_stiffness * place.value;
    found.by_setting += rates[PressedForce::normal_stiffness] * place.value;
    for (Index a = 0; a < n; ++a) {
      found.by_motion(closing * n + a) =
          std::polar(here.normal_stiffness, -orders[static_cast<std::size_t>(a)] * place.angle);
    }
  }
  if (found.value > 0) return found;
  return {0, HarmonicVector::Zero(x.size()), 0, 0};
}

void PressedElement::second(const ElementForce& /*at*/, std::span<const int> orders, const HarmonicVector& x,
                            double load, bool beyond, const Way& way, ElementForce& change) const {
  const auto moved = [&](const HarmonicVector& motion, double log_load, double setting, ElementForce& out) {
    force_at(orders, motion, load * std::exp(log_load), setting, beyond, true, out);
  };
  const double scale = settings_.scale();
  difference(moved, x, way, scale > 0 ? scale : 1, smooth_step, change);
}

}  // namespace arcslip
