#include "arcslip/elements/jenkins.hpp"

#include <cmath>
#include <stdexcept>

#include "arcslip/elements/hysteresis_loop.hpp"
#include "arcslip/elements/pressed/pressed_law.hpp"
#include "arcslip/elements/pressed/pressed_readings.hpp"
#include "arcslip/elements/two_phases.hpp"
#include "elements/pressed/moving_arcs.hpp"

namespace arcslip {

Jenkins::Jenkins(double stiffness, double slip_per_load)
    : stiffness_(stiffness), slip_per_load_(slip_per_load) {
  if (!(stiffness > 0 && slip_per_load > 0))
    throw std::invalid_argument("Jenkins: stiffness and slip threshold must be positive");
}

void Jenkins::force(std::span<const int> orders, const HarmonicVector& x, double load, bool slips,
                    bool derivatives, ElementForce& out) const {
  if (!all_odd(orders)) return force_of_any(orders, x, load, slips, derivatives, out);
  if (!slips) return out.set_linear(stiffness_, x, derivatives);
  const OddMotion motion(orders, x);
  const HysteresisLoop loop(motion, threshold(load));
  loop.force(out.harmonics);
  out.harmonics *= stiffness_;
  out.energy = stiffness_ * loop.energy();
  out.swing = loop.swing();
  out.further_slips = loop.further_slips();
  out.by_setting.resize(0);
  if (!derivatives) return;
  loop.derivative(out.linear, out.conjugate);
  out.linear *= stiffness_;
  out.conjugate *= stiffness_;
  out.by_log_load = out.harmonics;  // f is homogeneous in x and S
  out.by_log_load.noalias() -= out.linear * x;
  out.by_log_load.noalias() -= out.conjugate * x.conjugate();
}

void Jenkins::force_of_any(std::span<const int> orders, const HarmonicVector& x, double load, bool slips,
                           bool derivatives, ElementForce& out) const {
  const double limit = stiffness_ * threshold(load);
  const PressedForce found = pressed_force({1, stiffness_, 0, limit}, orders, x,
                                           ComplexVector::Zero(x.size()), derivatives, course(slips));
  out.harmonics = found.tangential;
  out.energy = found.energy;
  if (slips) out.swing = Swing::of(orders, x);
  out.further_slips = found.further_slips;
  out.by_setting.resize(0);
  if (derivatives) set_derivatives(found, limit, out);
}

void Jenkins::set_derivatives(const PressedForce& found, double limit, ElementForce& out) {
  out.linear = found.tangential_by_sliding.linear;
  out.conjugate = found.tangential_by_sliding.conjugate;
  out.by_log_load = limit * found.tangential_by[PressedForce::normal_force];
}

bool Jenkins::in_two_phases(const TwoPhases& phases, double load, const ComplexVector& x, double ratio,
                            bool derivatives, LineForce& out) const {
  phases.slide(stiffness_, threshold(load), x, ratio, derivatives, out);
  return true;
}

DisturbedLaw Jenkins::disturbed(std::span<const int> orders, const HarmonicVector& x, double load,
                                bool slips) const {
  if (!slips) return DisturbedLaw::constant(Matrix::Constant(1, 1, stiffness_));
  if (all_odd(orders)) throw std::logic_error("Jenkins: odd motions have a hysteresis loop");
  const PressedSettings settings{1, stiffness_, 0, stiffness_ * threshold(load)};
  return pressed_law(settings,
                     PressedArcs(settings, sliding_motion(orders, x, course(slips)),
                                 PeriodicMotion(ComplexVector::Zero(1)), course(slips)),
                     1);
}

std::shared_ptr<const Element> Jenkins::alone() const {
  auto same = std::make_shared<Jenkins>(*this);
  same->is_alone_ = true;
  return same;
}

PressedArcs::Course Jenkins::course(bool slips) const {
  using Course = PressedArcs::Course;
  if (is_alone_) return slips ? Course::drifts : Course::rests;
  return slips ? Course::slips : Course::sticks;
}

void Jenkins::second_of_any(std::span<const int> orders, const HarmonicVector& x, double load, bool slips,
                            const Way& way, ElementForce& change) const {
  const double limit = stiffness_ * threshold(load);
  PressedChange along{way.motion, ComplexVector::Zero(x.size())};
  along.by[PressedForce::normal_force] = limit * way.log_load;
  const MovingArcs moving({1, stiffness_, 0, limit}, orders, x, along.closing, course(slips), along);
  const auto filled = [&](const PressedForce& force, double steps) {
    ElementForce out;
    set_derivatives(force, limit * (1 + steps * way.log_load), out);
    return out;
  };
  moving.add_change(way.pace(x, 1), filled, change);
}

std::optional<RestingForce> Jenkins::resting_force(std::span<const int> orders, const HarmonicVector& x,
                                                   double load) const {
  const PressedSettings settings{1, stiffness_, 0, stiffness_ * threshold(load)};
  const PressedArcs course(settings, PeriodicMotion(orders, x, highest_order(orders)),
                           PeriodicMotion(ComplexVector::Zero(1)), PressedArcs::Course::sticks);
  return RestingForce{course.least_mean_force(), course.greatest_mean_force()};
}

std::vector<MotionNumber> Jenkins::read(std::span<const int> orders, const HarmonicVector& x, double load,
                                        bool slips, bool derivatives) const {
  const double limit = stiffness_ * threshold(load);
  const ContactReadings found = pressed_readings({1, stiffness_, 0, limit}, orders, x,
                                                 ComplexVector::Zero(x.size()), course(slips), derivatives);
  const auto told = [&](const ContactNumber& number) {
    return MotionNumber{number.value, number.by_motion.head(x.size()),
                        limit * number.by[PressedForce::normal_force], 0};
  };
  return {told(found.greatest_traction), told(found.slip_fraction)};
}

void Jenkins::second(const ElementForce& at, std::span<const int> orders, const HarmonicVector& x,
                     double load, bool slips, const Way& way, ElementForce& change) const {
  if (!all_odd(orders)) return second_of_any(orders, x, load, slips, way, change);
  const double limit = threshold(load);
  HysteresisLoop(OddMotion(orders, x), limit)
      .second(way.motion, limit * way.log_load, change.linear, change.conjugate);
  change.linear *= stiffness_;
  change.conjugate *= stiffness_;
  change.by_log_load = at.by_log_load * way.log_load;  // f is homogeneous in x and S
  change.by_log_load -= change.linear * x + change.conjugate * x.conjugate();
}

}  // namespace arcslip
