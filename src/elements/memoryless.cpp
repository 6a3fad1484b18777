#include "arcslip/elements/memoryless.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <vector>

#include "arcslip/elements/two_phases.hpp"
#include "arcslip/motion/periodic_motion.hpp"
#include "elements/harmonic_turn.hpp"
#include "motion/bracketed_newton.hpp"

namespace arcslip {
namespace {

/// The motion over the part of a period that averages are taken over: half of one of odd orders.
class Passage {
 public:
  Passage(std::span<const int> orders, const HarmonicVector& x) : orders_(orders), odd_(orders, x) {
    if (!all_odd(orders)) any_.emplace(orders, x, highest_order(orders));
  }

  double period() const { return any_ ? two_pi : pi; }
  int highest() const { return highest_order(orders_); }
  double value(double theta) const { return any_ ? any_->value(theta) : odd_.value(theta); }
  double slope(double theta) const { return any_ ? any_->at(theta).first : odd_.slopes(theta).first; }

  /// Where it turns back; of a constant at 0.
  Angles turns() const {
    if (!any_) return odd_.turning_points();
    Angles turns;
    for (const double angle : any_->derivative().zeros()) turns.push(angle);
    if (turns.count == 0) turns.push(0);
    return turns;
  }
  Swing swing(const Angles& turns) const {
    return any_ ? Swing::at(*any_, turns.all()) : Swing::of_odd(odd_.maximum(turns));
  }

 private:
  std::span<const int> orders_;
  OddMotion odd_;
  std::optional<PeriodicMotion> any_;
};

/// A stretch of it in one zone.
struct Stretch {
  double begin;
  double end;
  int zone;
  int next;  ///< the zone behind it, which may be the same
};

/// Calls `use` with all of them, from a turning point on. No motion is zero.
template <class Use>
void each_stretch(const PiecewiseLaw& law, const Passage& motion, const Angles& turns, const Use& use) {
  for (int i = 0; i < turns.count; ++i) {
    double begin = turns[i];
    const double end = i + 1 < turns.count ? turns[i + 1] : turns[0] + motion.period();
    int zone = law.zone_at(motion.value(begin));
    const int last = law.zone_at(motion.value(end));
    const int way = last > zone ? 1 : -1;
    while (zone != last) {
      const double level = way > 0 ? law.ends(zone).high : law.ends(zone).low;
      const double crossing = bracketed_newton(
          [&](double theta) { return std::pair(motion.value(theta) - level, motion.slope(theta)); },
          0.5 * (begin + end), begin, end, way > 0);
      use(Stretch{begin, crossing, zone, zone + way});
      begin = crossing;
      zone += way;
    }
    use(Stretch{begin, end, zone, zone});
  }
}

/// Calls `use` with angle, share and zone of nodes that integrate all products exactly where the motion stays
/// in the first piece, or over stretches between the turning points to rounding.
template <class Use>
void each_node(const PiecewiseLaw& law, const Passage& motion, const Angles* turns, const Use& use) {
  const double period = motion.period();
  const int highest = (law.degree() + 1) * motion.highest();
  if (turns == nullptr) {
    const int count = period > pi ? highest + 1 : highest / 2 + 1;
    for (int k = 0; k < count; ++k) use(period * k / count, 1.0 / count, 0);
    return;
  }
  each_stretch(law, motion, *turns, [&](const Stretch& stretch) {
    each_gauss_node(stretch.begin, stretch.end, highest,
                    [&](double theta, double weight) { use(theta, weight / period, stretch.zone); });
  });
}

/// k_m of the slope by the polynomial of one zone, in full periods.
std::vector<Complex> slope_harmonics(const PiecewiseLaw& law, const Passage& motion, int zone) {
  const int highest = std::max(law.degree() - 1, 0) * motion.highest();
  const int count = 2 * highest + 1;
  std::vector<Complex> harmonics(static_cast<std::size_t>(highest + 1));
  for (int k = 0; k < count; ++k) {
    const double theta = two_pi * k / count;
    const double slope = law.slope(motion.value(theta), zone);
    for (int m = 0; m <= highest; ++m)
      harmonics[static_cast<std::size_t>(m)] +=
          (m == 0 ? 1 : 2) * slope / count * std::polar(1.0, -m * theta);
  }
  return harmonics;
}

}  // namespace

MemorylessElement::MemorylessElement(PiecewiseLaw law, double reference, std::string beyond)
    : law_(std::move(law)), reference_(reference), beyond_(std::move(beyond)) {
  if (!(reference > 0)) throw std::invalid_argument("MemorylessElement: the reference must be positive");
}

void MemorylessElement::force(std::span<const int> orders, const HarmonicVector& x, double /*load*/,
                              bool beyond, bool derivatives, ElementForce& out) const {
  const Index count = x.size();
  out.harmonics.setZero(count);
  out.energy = 0;
  out.by_setting.setZero(law_.is_varied() ? count : 0);
  if (derivatives) {
    out.linear.setZero(count, count);
    out.conjugate.setZero(count, count);
    out.by_log_load.setZero(count);
  }
  const Passage motion(orders, x);
  Angles turns;
  if (crosses(beyond)) {
    turns = motion.turns();
    if (has_border()) out.swing = motion.swing(turns);
  }
  HarmonicTurn turn(orders);
  each_node(law_, motion, crosses(beyond) ? &turns : nullptr, [&](double theta, double share, int zone) {
    turn.go_to(theta);
    const double here = turn.value(x);
    turn.add_force(share * law_.value(here, zone), out.harmonics);
    if (!derivatives) return;
    turn.add_slope(share * law_.slope(here, zone), out.linear, out.conjugate);
    if (law_.is_varied()) turn.add_force(share * law_.by_setting(here, zone), out.by_setting);
  });
}

bool MemorylessElement::in_two_phases(const TwoPhases& phases, double /*load*/, const ComplexVector& x,
                                      double /*ratio*/, bool derivatives, LineForce& out) const {
  if (law_.pieces().size() > 1) return false;
  phases.act([this](double at) { return std::pair(law_.value(at, 0), law_.slope(at, 0)); }, x, derivatives,
             out);
  return true;
}

DisturbedLaw MemorylessElement::disturbed(std::span<const int> orders, const HarmonicVector& x,
                                          double /*load*/, bool beyond) const {
  DisturbedLaw found;
  const Passage motion(orders, x);
  if (!crosses(beyond)) {
    found.add_slope(0, motion.period(), slope_harmonics(law_, motion, 0));
    return found;
  }
  each_stretch(law_, motion, motion.turns(), [&](const Stretch& stretch) {
    found.add_slope(stretch.begin, stretch.end - stretch.begin, slope_harmonics(law_, motion, stretch.zone));
  });
  return found;
}

VaryingStiffness MemorylessElement::stiffness_in_time(std::span<const int> orders,
                                                      const HarmonicVector& x) const {
  VaryingStiffness stiffness;
  const Passage motion(orders, x);
  constexpr double touch = 1 + 1e-9;  // a longer one holds something
  const Angles turns = has_border() ? motion.turns() : Angles{};
  if (!has_border() || motion.swing(turns).peak() <= touch * law_.pieces().front().end.value) {
    const std::vector<Complex> all = slope_harmonics(law_, motion, 0);
    for (std::size_t m = 0; m < all.size(); m += 2) stiffness.harmonics.push_back(all[m]);
    return stiffness;
  }
  each_stretch(law_, motion, turns, [&](const Stretch& stretch) {
    stiffness.arcs.push_back(
        {stretch.begin, stretch.end - stretch.begin, slope_harmonics(law_, motion, stretch.zone)});
  });
  return stiffness;
}

/// Beside the change within its pieces, each stretch ends elsewhere, by (de - dx)/x' where its zone ends at
/// e.
void MemorylessElement::second(const ElementForce& /*at*/, std::span<const int> orders,
                               const HarmonicVector& x, double /*load*/, bool beyond, const Way& way,
                               ElementForce& change) const {
  const Passage motion(orders, x);
  const Angles turns = crosses(beyond) ? motion.turns() : Angles{};
  HarmonicTurn turn(orders);
  each_node(law_, motion, crosses(beyond) ? &turns : nullptr, [&](double theta, double share, int zone) {
    turn.go_to(theta);
    const double here = turn.value(x);
    const double dx = turn.value(way.motion);
    double slope = law_.curvature(here, zone) * dx;
    if (law_.is_varied()) {
      const double by_both = law_.slope_by_setting(here, zone);
      slope += by_both * way.setting;
      turn.add_force(share * (by_both * dx + law_.second_by_setting(here, zone) * way.setting),
                     change.by_setting);
    }
    turn.add_slope(share * slope, change.linear, change.conjugate);
  });
  if (!crosses(beyond)) return;
  each_stretch(law_, motion, turns, [&](const Stretch& stretch) {
    if (stretch.zone == stretch.next) return;
    turn.go_to(stretch.end);
    const double here = turn.value(x);
    const double drop = law_.slope(here, stretch.zone) - law_.slope(here, stretch.next);
    const double late =
        (law_.end_by_setting(stretch.zone, stretch.next) * way.setting - turn.value(way.motion)) /
        (motion.period() * motion.slope(stretch.end));
    turn.add_slope(drop * late, change.linear, change.conjugate);
    if (law_.is_varied())
      turn.add_force((law_.by_setting(here, stretch.zone) - law_.by_setting(here, stretch.next)) * late,
                     change.by_setting);
  });
}

std::shared_ptr<const Element> cubic_spring(const Jet& coefficient, double reference) {
  constexpr double endless = std::numeric_limits<double>::infinity();
  return std::make_shared<MemorylessElement>(PiecewiseLaw({{endless, {0, 0, 0, coefficient}}}), reference);
}

}  // namespace arcslip
