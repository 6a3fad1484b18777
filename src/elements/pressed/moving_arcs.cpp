#include "elements/pressed/moving_arcs.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace arcslip {
namespace {

using Arc = PressedArcs::Arc;
using Phase = PressedArcs::Phase;
using Local = PeriodicMotion::Local;

/// Of an event where a function of theta and of steps is zero: how fast theta goes. One that does not cross
/// zero stays.
double pace_of_zero(double by_step, double by_angle) { return by_angle != 0 ? -by_step / by_angle : 0; }

}  // namespace

/// Values and rates at one theta, and what follows for arcs.
class MovingArcs::Rates {
 public:
  explicit Rates(const MovingArcs& of)
      : k_(of.settings_.tangential_stiffness),
        mu_(of.settings_.friction),
        dk_(of.change_.by[PressedForce::tangential_stiffness]),
        dmu_(of.change_.by[PressedForce::friction]),
        sliding_(sliding_motion(of.orders_, of.sliding_, of.course_)),
        slides_(sliding_motion(of.orders_, of.change_.sliding, of.course_)),
        press_(pressing_motion(of.settings_, PeriodicMotion(of.orders_, of.closing_, sliding_.highest()))),
        presses_(pressing_rate(of)) {}

  /// Of a stick arc, what begins with its anchor.
  void hold(const Arc& arc, Rate& rate) const {
    const Values at(*this, arc.anchor);
    if (!arc.was_apart) {  // A = k_t r + c n, where this stands still
      const double c = arc.by_press;
      const double dc = std::copysign(1.0, c) * dmu_;
      rate.anchor = pace_of_zero(k_ * at.dr1 + dk_ * at.r1 + c * at.dn1 + dc * at.n1, k_ * at.r2 + c * at.n2);
      rate.offset = k_ * at.dr + dk_ * at.r + c * at.dn + dc * at.n;
      rate.by_press = dc;
      return;
    }
    rate.anchor = pace_of_zero(at.dn, at.n1);  // A = k_t r, where n = 0
    rate.offset = k_ * at.dr + dk_ * at.r + k_ * at.r1 * rate.anchor;
    if (arc.by_press == 0 || at.n1 == 0) return;
    const double ratio = at.r1 / at.n1;
    const double dr1 = at.dr1 + at.r2 * rate.anchor;
    const double dn1 = at.dn1 + at.n2 * rate.anchor;
    rate.by_press = -dk_ * ratio - k_ * (dr1 - ratio * dn1) / at.n1;
  }

  /// Of an arc that begins behind another one.
  double begin(const Arc& arc, const Rate& own, const Arc& before, const Rate& of_before) const {
    if (arc.phase == Phase::stick) return own.anchor;
    const Values at(*this, before.begin + before.width);
    if (arc.phase == Phase::apart || before.phase == Phase::apart) return pace_of_zero(at.dn, at.n1);
    if (before.phase != Phase::stick) return 0;
    const double c = -arc.direction * mu_;  // slip begins where k_t r + c n = A
    const double dc = -arc.direction * dmu_;
    const double bound = k_ * at.dr + dk_ * at.r + c * at.dn + dc * at.n;
    return pace_of_zero(bound - of_before.offset, k_ * at.r1 + c * at.n1);
  }

 private:
  struct Values {
    Values(const Rates& of, double theta) {
      const Local slid = of.sliding_.at(theta);
      const Local pressed = of.press_.at(theta);
      const Local slides = of.slides_.at(theta);
      const Local presses = of.presses_.at(theta);
      r = slid.value, r1 = slid.first, r2 = of.sliding_.derivative().at(theta).first;
      n = pressed.value, n1 = pressed.first, n2 = of.press_.derivative().at(theta).first;
      dr = slides.value, dr1 = slides.first;
      dn = presses.value, dn1 = presses.first;
    }
    double r, r1, r2;  // and derivatives by theta
    double n, n1, n2;
    double dr, dr1;  // by steps
    double dn, dn1;
  };

  static PeriodicMotion pressing_rate(const MovingArcs& of) {
    const auto& by = of.change_.by;
    const int highest = highest_order(of.orders_);
    ComplexVector rate = of.settings_.normal_stiffness *
                         PeriodicMotion(of.orders_, of.change_.closing, highest).coefficients();
    rate +=
        by[PressedForce::normal_stiffness] * PeriodicMotion(of.orders_, of.closing_, highest).coefficients();
    rate(0) += by[PressedForce::normal_force];
    return PeriodicMotion(std::move(rate));
  }

  double k_, mu_, dk_, dmu_;
  PeriodicMotion sliding_, slides_;
  PeriodicMotion press_, presses_;
};

MovingArcs::MovingArcs(const PressedSettings& settings, std::span<const int> orders,
                       const ComplexVector& sliding, const ComplexVector& closing, PressedArcs::Course course,
                       PressedChange change)
    : settings_(settings),
      orders_(orders),
      sliding_(sliding),
      closing_(closing),
      course_(course),
      change_(std::move(change)),
      arcs_(PressedArcs(settings, sliding_motion(orders, sliding, course),
                        PeriodicMotion(orders, closing, highest_order(orders)), course)
                .arcs()),
      rates_(arcs_.size()) {
  const Rates rates(*this);
  for (std::size_t i = 0; i < arcs_.size(); ++i) {
    if (arcs_[i].is_set) rates.hold(arcs_[i], rates_[i]);
  }
  for (std::size_t i = 0; i < arcs_.size(); ++i) {
    const std::size_t before = (i > 0 ? i : arcs_.size()) - 1;
    rates_[i].begin = rates_[before].end = rates.begin(arcs_[i], rates_[i], arcs_[before], rates_[before]);
  }
}

/// Of the fastest end of an arc, theta per step.
double MovingArcs::pace() const {
  double fastest = 0;
  for (const Rate& rate : rates_) fastest = std::max({fastest, std::abs(rate.begin), std::abs(rate.anchor)});
  return fastest;
}

void MovingArcs::add_change(
    double pace, const std::function<ElementForce(const PressedForce& force, double steps)>& filled,
    ElementForce& change) const {
  constexpr double part = 1e-5;
  const double fastest = std::max(pace, this->pace());
  if (!(fastest > 0)) return;
  const double step = part / fastest;
  const ElementForce ahead = filled(at(step), step);
  const ElementForce behind = filled(at(-step), -step);
  change.add_rate(ahead, behind, step);
}

PressedSettings MovingArcs::settings_at(double steps) const {
  const auto& by = change_.by;
  return {settings_.friction + steps * by[PressedForce::friction],
          settings_.tangential_stiffness + steps * by[PressedForce::tangential_stiffness],
          settings_.normal_stiffness + steps * by[PressedForce::normal_stiffness],
          settings_.normal_force + steps * by[PressedForce::normal_force]};
}

PressedForce MovingArcs::at(double steps) const {
  std::vector<Arc> arcs = arcs_;
  for (std::size_t i = 0; i < arcs.size(); ++i) {
    const Rate& rate = rates_[i];
    arcs[i].begin += steps * rate.begin;
    arcs[i].width += steps * (rate.end - rate.begin);
    arcs[i].anchor += steps * rate.anchor;
    arcs[i].offset += steps * rate.offset;
    arcs[i].by_press += steps * rate.by_press;
  }
  return pressed_force(settings_at(steps), orders_, sliding_ + steps * change_.sliding,
                       closing_ + steps * change_.closing, true, arcs, course_);
}

}  // namespace arcslip
