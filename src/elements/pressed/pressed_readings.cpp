#include "arcslip/elements/pressed/pressed_readings.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "arcslip/motion/swing.hpp"

namespace arcslip {
namespace {

using Arc = PressedArcs::Arc;
using Phase = PressedArcs::Phase;

/// Goes through the arcs of a course.
class PressedReader {
 public:
  PressedReader(const PressedSettings& settings, std::span<const int> orders, const PeriodicMotion& sliding,
                const PeriodicMotion& closing, PressedArcs::Course course)
      : settings_(settings),
        orders_(orders),
        slides_(sliding),
        closes_(closing),
        drifts_(course == PressedArcs::Course::drifts),
        course_(settings, sliding, closing, course),
        slide_rate_(sliding.derivative()),
        press_rate_(course_.press().derivative()) {}

  PressedReadings read() const {
    PressedReadings all{greatest(), zero(fraction_of(course_.arcs(), Phase::slip)),
                        zero(fraction_of(course_.arcs(), Phase::apart))};
    const std::vector<Arc>& arcs = course_.arcs();
    if (arcs.size() == 1) return all;
    for (const Arc& arc : arcs) {
      if (arc.phase == Phase::stick) continue;
      PressedNumber& fraction = arc.phase == Phase::slip ? all.slip_fraction : all.apart_fraction;
      add_begin(arc, -1 / two_pi, fraction);
      add_end(arc, 1 / two_pi, fraction);
    }
    return all;
  }

 private:
  PressedNumber zero(double value) const {
    const Index n = std::ssize(orders_);
    return {value, HarmonicVector::Zero(n), HarmonicVector::Zero(n), {}};
  }

  const Arc& beside(const Arc& arc, std::size_t steps) const {
    const std::vector<Arc>& arcs = course_.arcs();
    return arcs[(static_cast<std::size_t>(&arc - arcs.data()) + steps) % arcs.size()];
  }
  const Arc& before(const Arc& arc) const { return beside(arc, course_.arcs().size() - 1); }
  const Arc& behind(const Arc& arc) const { return beside(arc, 1); }

  /// Adds so much of a change of k_t r at theta, or of its slope.
  void add_slide(double theta, double part, bool is_slope, PressedNumber& sum) const {
    const double k = settings_.tangential_stiffness;
    for (Index a = 0; a < sum.by_sliding.size(); ++a) {
      const int h = orders_[static_cast<std::size_t>(a)];
      const Complex turn = std::polar(1.0, -h * theta);
      sum.by_sliding(a) += part * k * (is_slope ? Complex(0, -h) * turn : turn);
      if (h == 0 && drifts_)
        sum.by_sliding(a) += Complex(0, part * k * (is_slope ? 1 : theta));  // of a drift
    }
    const PeriodicMotion::Local here = slides_.at(theta);
    sum.by[PressedForce::tangential_stiffness] += part * (is_slope ? here.first : here.value);
  }

  /// The same of n.
  void add_press(double theta, double part, bool is_slope, PressedNumber& sum) const {
    for (Index a = 0; a < sum.by_closing.size(); ++a) {
      const int h = orders_[static_cast<std::size_t>(a)];
      const Complex turn = part * settings_.normal_stiffness * std::polar(1.0, -h * theta);
      sum.by_closing(a) += is_slope ? Complex(0, -h) * turn : turn;
    }
    const PeriodicMotion::Local here = closes_.at(theta);
    sum.by[PressedForce::normal_stiffness] += part * (is_slope ? here.first : here.value);
    if (!is_slope) sum.by[PressedForce::normal_force] += part;
  }

  /// Of mu n.
  void add_limit(double theta, double part, bool is_slope, PressedNumber& sum) const {
    add_press(theta, part * settings_.friction, is_slope, sum);
    const PeriodicMotion::Local here = course_.press().at(theta);
    sum.by[PressedForce::friction] += part * (is_slope ? here.first : here.value);
  }

  /// Of A of an arc of stick.
  void add_offset(const Arc& arc, double part, PressedNumber& sum) const {
    if (!arc.is_set) return;
    add_slide(arc.anchor, part, false, sum);
    add_press(arc.anchor, part * arc.by_press, false, sum);
    if (arc.was_apart || settings_.friction == 0) return;
    sum.by[PressedForce::friction] +=
        part * arc.by_press / settings_.friction * course_.press().value(arc.anchor);
  }

  /// B' and B".
  PeriodicMotion::Local bound_slope(double theta, int direction) const {
    const PeriodicMotion::Local slide = slide_rate_.at(theta);
    const PeriodicMotion::Local press = press_rate_.at(theta);
    const double k = settings_.tangential_stiffness;
    const double limit = direction * settings_.friction;
    return {k * slide.value - limit * press.value, k * slide.first - limit * press.first};
  }

  /// Adds so much of a change of where slip begins.
  void add_onset(const Arc& slip, double part, PressedNumber& sum) const {
    const double per = -part / bound_slope(slip.begin, slip.direction).value;
    add_slide(slip.begin, per, false, sum);
    add_limit(slip.begin, -slip.direction * per, false, sum);
    add_offset(before(slip), -per, sum);
  }
  void add_stop(double theta, int direction, double part, PressedNumber& sum) const {
    const double per = -part / bound_slope(theta, direction).first;
    add_slide(theta, per, true, sum);
    add_limit(theta, -direction * per, true, sum);
  }
  void add_touch(double theta, double part, PressedNumber& sum) const {
    add_press(theta, -part / press_rate_.value(theta), false, sum);
  }

  void add_begin(const Arc& arc, double part, PressedNumber& sum) const {
    const Arc& last = before(arc);
    if (arc.phase == Phase::apart || last.phase == Phase::apart) return add_touch(arc.begin, part, sum);
    if (last.phase == Phase::stick) return add_onset(arc, part, sum);
    add_stop(arc.begin, last.direction, part, sum);
  }
  void add_end(const Arc& arc, double part, PressedNumber& sum) const {
    const double end = arc.begin + arc.width;
    if (arc.phase == Phase::apart || behind(arc).phase == Phase::apart) return add_touch(end, part, sum);
    add_stop(end, arc.direction, part, sum);
  }

  /// A place where |f| may be greatest.
  struct Place {
    const Arc* arc;
    double theta;
    double force;
  };

  void add_place(const Arc& arc, double theta, std::vector<Place>& places) const {
    const double force = arc.phase == Phase::stick
                             ? settings_.tangential_stiffness * slides_.value(theta) - arc.offset
                             : arc.direction * settings_.friction * course_.press().value(theta);
    places.push_back({&arc, theta, force});
  }

  /// Both ends of slip, extremes within arcs, and where nothing moves the begin of stick.
  std::vector<Place> places() const {
    const std::vector<double> turns = slide_rate_.zeros();
    const std::vector<double> presses = press_rate_.zeros();
    std::vector<Place> all;
    for (const Arc& arc : course_.arcs()) {
      if (arc.phase == Phase::apart) continue;
      add_place(arc, arc.begin, all);
      if (arc.phase == Phase::slip) add_place(arc, arc.begin + arc.width, all);
      for (const double angle : arc.phase == Phase::stick ? turns : presses) {
        const double way = angle - arc.begin;
        const double turned = way - two_pi * std::floor(way / two_pi);
        if (turned < arc.width) add_place(arc, arc.begin + turned, all);
      }
    }
    return all;
  }

  PressedNumber greatest() const {
    constexpr double rounding = 1e-11;
    const std::vector<Place> all = places();
    double most = 0;
    for (const Place& place : all) most = std::max(most, std::abs(place.force));
    PressedNumber number = zero(most);
    if (!(most > 0)) return number;
    const auto is_greatest = [=](const Place& place) {
      return std::abs(place.force) >= (1 - rounding) * most;
    };
    const auto count = static_cast<double>(std::count_if(all.begin(), all.end(), is_greatest));
    for (const Place& place : all) {
      if (is_greatest(place)) add_force(place, (place.force > 0 ? 1 : -1) / count, number);
    }
    return number;
  }

  void add_force(const Place& place, double part, PressedNumber& sum) const {
    const auto& [arc, theta, force] = place;
    if (arc->phase == Phase::stick) {
      add_slide(theta, part, false, sum);
      return add_offset(*arc, -part, sum);
    }
    add_limit(theta, part * arc->direction, false, sum);
    const double slope = settings_.friction * press_rate_.value(theta);
    if (theta == arc->begin && slope != 0 && before(*arc).phase == Phase::stick)
      add_onset(*arc, part * arc->direction * slope, sum);
  }

  const PressedSettings& settings_;
  std::span<const int> orders_;
  const PeriodicMotion& slides_;
  const PeriodicMotion& closes_;
  bool drifts_;
  PressedArcs course_;
  PeriodicMotion slide_rate_;
  PeriodicMotion press_rate_;
};

}  // namespace

PressedReadings pressed_readings(const PressedSettings& settings, std::span<const int> orders,
                                 const ComplexVector& sliding, const ComplexVector& closing,
                                 PressedArcs::Course course) {
  const PeriodicMotion slides = sliding_motion(orders, sliding, course);
  const PeriodicMotion closes(orders, closing, highest_order(orders));
  return PressedReader(settings, orders, slides, closes, course).read();
}

}  // namespace arcslip
