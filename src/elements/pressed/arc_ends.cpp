#include "elements/pressed/arc_ends.hpp"

#include <cmath>

namespace arcslip {

using Arc = PressedArcs::Arc;

ArcEnds::ArcEnds(const PressedSettings& settings, std::span<const int> orders, const PeriodicMotion& sliding,
                 const PeriodicMotion& closing, bool drifts)
    : settings_(settings),
      orders_(orders),
      slides_(sliding),
      closes_(closing),
      drifts_(drifts),
      press_(pressing_motion(settings, closing)),
      slide_rate_(sliding.derivative()),
      press_rate_(press_.derivative()) {}

ContactNumber ArcEnds::zero(double value) const {
  return {value, ComplexVector::Zero(2 * std::ssize(orders_)), {}};
}

void ArcEnds::add_slide(double theta, double part, bool is_slope, ContactNumber& sum) const {
  const double k = settings_.tangential_stiffness;
  for (Index a = 0; a < std::ssize(orders_); ++a) {
    const int h = orders_[static_cast<std::size_t>(a)];
    const Complex turn = std::polar(1.0, -h * theta);
    sum.by_motion(a) += part * k * (is_slope ? Complex(0, -h) * turn : turn);
    if (h == 0 && drifts_) sum.by_motion(a) += Complex(0, part * k * (is_slope ? 1 : theta));  // of a drift
  }
  const PeriodicMotion::Local here = slides_.at(theta);
  sum.by[PressedForce::tangential_stiffness] += part * (is_slope ? here.first : here.value);
}

void ArcEnds::add_press(double theta, double part, bool is_slope, ContactNumber& sum) const {
  const Index n = std::ssize(orders_);
  for (Index a = 0; a < n; ++a) {
    const int h = orders_[static_cast<std::size_t>(a)];
    const Complex turn = part * settings_.normal_stiffness * std::polar(1.0, -h * theta);
    sum.by_motion(n + a) += is_slope ? Complex(0, -h) * turn : turn;
  }
  const PeriodicMotion::Local here = closes_.at(theta);
  sum.by[PressedForce::normal_stiffness] += part * (is_slope ? here.first : here.value);
  if (!is_slope) sum.by[PressedForce::normal_force] += part;
}

void ArcEnds::add_limit(double theta, double part, bool is_slope, ContactNumber& sum) const {
  add_press(theta, part * settings_.friction, is_slope, sum);
  const PeriodicMotion::Local here = press_.at(theta);
  sum.by[PressedForce::friction] += part * (is_slope ? here.first : here.value);
}

void ArcEnds::add_offset(const Arc& arc, double part, ContactNumber& sum) const {
  if (!arc.is_set) return;
  add_slide(arc.anchor, part, false, sum);
  add_press(arc.anchor, part * arc.by_press, false, sum);
  if (arc.was_apart || settings_.friction == 0) return;
  sum.by[PressedForce::friction] += part * arc.by_press / settings_.friction * press_.value(arc.anchor);
}

/// dA/dn is -+mu where slip has ended, and -k_t r'/n' where the parts have touched.
void ArcEnds::add_by_press(const Arc& arc, double part, ContactNumber& sum) const {
  if (arc.by_press == 0) return;
  if (!arc.was_apart) {
    sum.by[PressedForce::friction] += std::copysign(part, part * arc.by_press);
    return;
  }
  const double per = -part / press_rate_.value(arc.anchor);
  add_slide(arc.anchor, per, true, sum);
  add_press(arc.anchor, per * arc.by_press, true, sum);
  add_touch(arc.anchor, per * bound_slope(arc.anchor, arc.by_press).first, sum);
}

void ArcEnds::add_anchor(const Arc& arc, double part, ContactNumber& sum) const {
  if (arc.was_apart) return add_touch(arc.anchor, part, sum);
  add_stop(arc.anchor, arc.by_press < 0 ? 1 : -1, part, sum);
}

/// First and second derivative of k_t r + c n, which a bound is with c = -+mu.
PeriodicMotion::Local ArcEnds::bound_slope(double theta, double by_press) const {
  const PeriodicMotion::Local slide = slide_rate_.at(theta);
  const PeriodicMotion::Local press = press_rate_.at(theta);
  const double k = settings_.tangential_stiffness;
  return {k * slide.value + by_press * press.value, k * slide.first + by_press * press.first};
}

void ArcEnds::add_onset(const Arc& slip, const Arc& stick, double part, ContactNumber& sum) const {
  const double per = -part / bound_slope(slip.begin, -slip.direction * settings_.friction).value;
  add_slide(slip.begin, per, false, sum);
  add_limit(slip.begin, -slip.direction * per, false, sum);
  add_offset(stick, -per, sum);
}

void ArcEnds::add_stop(double theta, int direction, double part, ContactNumber& sum) const {
  const double per = -part / bound_slope(theta, -direction * settings_.friction).first;
  add_slide(theta, per, true, sum);
  add_limit(theta, -direction * per, true, sum);
}

void ArcEnds::add_touch(double theta, double part, ContactNumber& sum) const {
  add_press(theta, -part / press_rate_.value(theta), false, sum);
}

}  // namespace arcslip
