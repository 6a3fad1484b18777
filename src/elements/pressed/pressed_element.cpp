#include "arcslip/elements/pressed/pressed_element.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "arcslip/elements/pressed/pressed_law.hpp"
#include "arcslip/elements/pressed/pressed_readings.hpp"
#include "elements/pressed/moving_arcs.hpp"

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

std::array<double, PressedForce::settings> PressedElement::Settings::rates(double load,
                                                                           double setting) const {
  const auto rate = [setting](const Jet& number) { return shifted(number, setting).first; };
  return {rate(friction), rate(tangential), rate(normal), rate(normal_force) + load * rate(normal_per_load)};
}

bool PressedElement::rests_beyond(double load) const {
  return !(settings_.friction.value > 0 && settings_.at(load, 0).normal_force > 0);
}

void PressedElement::force(std::span<const int> orders, const HarmonicVector& x, double load, bool beyond,
                           bool derivatives, ElementForce& out) const {
  const Index n = std::ssize(orders);
  const PressedSettings settings = settings_.at(load, 0);
  const PressedForce found =
      pressed_force(settings, orders, x.head(n), x.tail(n), derivatives, course(beyond));
  out.harmonics.resize(2 * n);
  out.harmonics << found.tangential, found.normal;
  out.harmonics(n + place_of_mean(orders)) -= std::max(0.0, settings.normal_force);
  out.energy = found.energy;
  out.further_slips = found.further_slips;
  out.by_setting.resize(0);
  if (derivatives) set_derivatives(found, orders, load, 0, out);
}

void PressedElement::set_derivatives(const PressedForce& found, std::span<const int> orders, double load,
                                     double setting, ElementForce& out) const {
  const Index n = std::ssize(orders);
  out.linear.setZero(2 * n, 2 * n);
  out.conjugate.setZero(2 * n, 2 * n);
  put(found.tangential_by_sliding, 0, 0, out);
  put(found.tangential_by_closing, 0, 1, out);
  put(found.normal_by_closing, 1, 1, out);
  const double rests_rate = settings_.at(load, setting).normal_force > 0 ? 1 : 0;
  const auto along = [&](const std::array<double, PressedForce::settings>& rates) {
    HarmonicVector all = HarmonicVector::Zero(2 * n);
    for (std::size_t s = 0; s < rates.size(); ++s) {
      if (rates[s] == 0) continue;
      all.head(n) += rates[s] * found.tangential_by[s];
      all.tail(n) += rates[s] * found.normal_by[s];
    }
    all(n + place_of_mean(orders)) -= rests_rate * rates[PressedForce::normal_force];
    return all;
  };
  std::array<double, PressedForce::settings> by_load{};
  by_load[PressedForce::normal_force] = settings_.by_log_load(load, setting);
  out.by_log_load = along(by_load);
  if (settings_.scale() > 0) out.by_setting = along(settings_.rates(load, setting));
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

std::optional<RestingForce> PressedElement::resting_force(std::span<const int> orders,
                                                          const HarmonicVector& x, double load) const {
  const Index n = std::ssize(orders);
  const int highest = highest_order(orders);
  const PressedArcs course(settings(load), PeriodicMotion(orders, x.head(n), highest),
                           PeriodicMotion(orders, x.tail(n), highest), PressedArcs::Course::sticks);
  return RestingForce{course.least_mean_force(), course.greatest_mean_force()};
}

std::vector<MotionNumber> PressedElement::read(std::span<const int> orders, const HarmonicVector& x,
                                               double load, bool beyond, bool derivatives) const {
  const Index n = std::ssize(orders);
  return told(settings_,
              pressed_readings(settings(load), orders, x.head(n), x.tail(n), course(beyond), derivatives),
              orders, x, load, 1);
}

std::vector<MotionNumber> PressedElement::told(const Settings& settings, const ContactReadings& found,
                                               std::span<const int> orders, const HarmonicVector& x,
                                               double load, Index closing) {
  const auto rates = settings.rates(load);
  const auto number = [&](const ContactNumber& one) {
    MotionNumber all{one.value, one.by_motion.head(x.size()),
                     settings.by_log_load(load, 0) * one.by[PressedForce::normal_force], 0};
    for (std::size_t s = 0; s < rates.size(); ++s) all.by_setting += rates[s] * one.by[s];
    return all;
  };
  return {number(found.greatest_traction), extreme_press(settings, orders, x, load, closing, false),
          extreme_press(settings, orders, x, load, closing, true), number(found.slip_fraction),
          number(found.apart_fraction)};
}

void PressedElement::second(const ElementForce& /*at*/, std::span<const int> orders, const HarmonicVector& x,
                            double load, bool beyond, const Way& way, ElementForce& change) const {
  const Index n = std::ssize(orders);
  PressedChange along{way.motion.head(n), way.motion.tail(n), settings_.rates(load)};
  for (double& rate : along.by) rate *= way.setting;
  along.by[PressedForce::normal_force] += settings_.by_log_load(load, 0) * way.log_load;
  const MovingArcs moving(settings_.at(load, 0), orders, x.head(n), x.tail(n), course(beyond), along);
  const auto filled = [&](const PressedForce& force, double steps) {
    ElementForce out;
    set_derivatives(force, orders, load * std::exp(steps * way.log_load), steps * way.setting, out);
    return out;
  };
  const double scale = settings_.scale();
  moving.add_change(way.pace(x, scale > 0 ? scale : 1), filled, change);
}

}  // namespace arcslip
