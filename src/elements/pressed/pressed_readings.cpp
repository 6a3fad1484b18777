#include "arcslip/elements/pressed/pressed_readings.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "arcslip/motion/swing.hpp"
#include "elements/pressed/arc_ends.hpp"

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
        slides_(sliding),
        course_(settings, sliding, closing, course),
        ends_(settings, orders, sliding, closing, course == PressedArcs::Course::drifts) {}

  ContactReadings read(bool derivatives) const {
    ContactReadings all{greatest(derivatives), ends_.zero(fraction_of(course_.arcs(), Phase::slip)),
                        ends_.zero(fraction_of(course_.arcs(), Phase::apart))};
    const std::vector<Arc>& arcs = course_.arcs();
    if (arcs.size() == 1 || !derivatives) return all;
    for (const Arc& arc : arcs) {
      if (arc.phase == Phase::stick) continue;
      ContactNumber& fraction = arc.phase == Phase::slip ? all.slip_fraction : all.apart_fraction;
      add_begin(arc, -1 / two_pi, fraction);
      add_end(arc, 1 / two_pi, fraction);
    }
    return all;
  }

 private:
  const Arc& beside(const Arc& arc, std::size_t steps) const {
    const std::vector<Arc>& arcs = course_.arcs();
    return arcs[(static_cast<std::size_t>(&arc - arcs.data()) + steps) % arcs.size()];
  }
  const Arc& before(const Arc& arc) const { return beside(arc, course_.arcs().size() - 1); }
  const Arc& behind(const Arc& arc) const { return beside(arc, 1); }

  void add_begin(const Arc& arc, double part, ContactNumber& sum) const {
    const Arc& last = before(arc);
    if (arc.phase == Phase::apart || last.phase == Phase::apart) return ends_.add_touch(arc.begin, part, sum);
    if (last.phase == Phase::stick) return ends_.add_onset(arc, last, part, sum);
    ends_.add_stop(arc.begin, last.direction, part, sum);
  }
  void add_end(const Arc& arc, double part, ContactNumber& sum) const {
    const double end = arc.begin + arc.width;
    if (arc.phase == Phase::apart || behind(arc).phase == Phase::apart)
      return ends_.add_touch(end, part, sum);
    ends_.add_stop(end, arc.direction, part, sum);
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
                             : arc.direction * settings_.friction * ends_.press().value(theta);
    places.push_back({&arc, theta, force});
  }

  /// Both ends of slip, extremes within arcs, and where nothing moves the begin of stick.
  std::vector<Place> places() const {
    const std::vector<double> turns = course_.turns();
    const std::vector<double> presses = ends_.press_rate().zeros();
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

  ContactNumber greatest(bool derivatives) const {
    constexpr double rounding = 1e-11;
    const std::vector<Place> all = places();
    double most = 0;
    for (const Place& place : all) most = std::max(most, std::abs(place.force));
    ContactNumber number = ends_.zero(most);
    if (!(most > 0) || !derivatives) return number;
    const auto is_greatest = [=](const Place& place) {
      return std::abs(place.force) >= (1 - rounding) * most;
    };
    const auto count = static_cast<double>(std::count_if(all.begin(), all.end(), is_greatest));
    for (const Place& place : all) {
      if (is_greatest(place)) add_force(place, (place.force > 0 ? 1 : -1) / count, number);
    }
    return number;
  }

  void add_force(const Place& place, double part, ContactNumber& sum) const {
    const auto& [arc, theta, force] = place;
    if (arc->phase == Phase::stick) {
      ends_.add_slide(theta, part, false, sum);
      return ends_.add_offset(*arc, -part, sum);
    }
    ends_.add_limit(theta, part * arc->direction, false, sum);
    const double slope = settings_.friction * ends_.press_rate().value(theta);
    const Arc& last = before(*arc);
    if (theta == arc->begin && slope != 0 && last.phase == Phase::stick)
      ends_.add_onset(*arc, last, part * arc->direction * slope, sum);
  }

  const PressedSettings& settings_;
  const PeriodicMotion& slides_;
  PressedArcs course_;
  ArcEnds ends_;
};

}  // namespace

ContactReadings pressed_readings(const PressedSettings& settings, std::span<const int> orders,
                                 const ComplexVector& sliding, const ComplexVector& closing,
                                 PressedArcs::Course course, bool derivatives) {
  const PeriodicMotion slides = sliding_motion(orders, sliding, course);
  const PeriodicMotion closes(orders, closing, highest_order(orders));
  return PressedReader(settings, orders, slides, closes, course).read(derivatives);
}

}  // namespace arcslip
