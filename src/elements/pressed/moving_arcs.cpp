#include "elements/pressed/moving_arcs.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "elements/pressed/arc_ends.hpp"

namespace arcslip {
namespace {

using Arc = PressedArcs::Arc;
using Phase = PressedArcs::Phase;

/// How fast a number goes along a change; one that is not told, as of an event that only touches, stays.
double along(const ContactNumber& number, const PressedChange& change) {
  const Index n = change.sliding.size();
  double rate = number.by_motion.head(n).dot(change.sliding).real();
  rate += number.by_motion.tail(n).dot(change.closing).real();
  for (std::size_t s = 0; s < change.by.size(); ++s) rate += number.by[s] * change.by[s];
  return std::isfinite(rate) ? rate : 0;
}

}  // namespace

MovingArcs::MovingArcs(const PressedSettings& settings, std::span<const int> orders,
                       const ComplexVector& sliding, const ComplexVector& closing, PressedArcs::Course course,
                       PressedChange change)
    : settings_(settings),
      orders_(orders),
      sliding_(sliding),
      closing_(closing),
      course_(course),
      change_(std::move(change)) {
  const PeriodicMotion slides = sliding_motion(orders, sliding, course);
  const PeriodicMotion closes(orders, closing, highest_order(orders));
  arcs_ = PressedArcs(settings, slides, closes, course).arcs();
  rates_.resize(arcs_.size());
  const ArcEnds ends(settings_, orders, slides, closes, course == PressedArcs::Course::drifts);
  const auto rate = [&](const auto& add) {
    ContactNumber number = ends.zero(0);
    add(number);
    return along(number, change_);
  };
  for (std::size_t i = 0; i < arcs_.size(); ++i) {
    const Arc& arc = arcs_[i];
    if (!arc.is_set) continue;
    rates_[i].anchor = rate([&](ContactNumber& sum) { ends.add_anchor(arc, 1, sum); });
    rates_[i].offset = rate([&](ContactNumber& sum) { ends.add_offset(arc, 1, sum); });
    rates_[i].by_press = rate([&](ContactNumber& sum) { ends.add_by_press(arc, 1, sum); });
  }
  for (std::size_t i = 0; i < arcs_.size(); ++i) {
    const std::size_t last = (i > 0 ? i : arcs_.size()) - 1;
    const Arc& arc = arcs_[i];
    const Arc& before = arcs_[last];
    const bool touches = arc.phase == Phase::apart || before.phase == Phase::apart;
    double begin = 0;  // of a phase that lasts
    if (arc.phase == Phase::stick)
      begin = rates_[i].anchor;
    else if (touches && last != i)
      begin = rate([&](ContactNumber& sum) { ends.add_touch(arc.begin, 1, sum); });
    else if (before.phase == Phase::stick)
      begin = rate([&](ContactNumber& sum) { ends.add_onset(arc, before, 1, sum); });
    rates_[i].begin = rates_[last].end = begin;
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
