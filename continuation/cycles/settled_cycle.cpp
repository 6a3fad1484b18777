#include "arcslip/continuation/cycles/settled_cycle.hpp"

#include <fmt/format.h>

#include <boost/numeric/odeint.hpp>
#include <cmath>
#include <stdexcept>

namespace arcslip::continuation {
namespace {

namespace odeint = boost::numeric::odeint;
using State = std::vector<double>;

constexpr double accuracy = 1e-8;
constexpr double close = 0.02;

/// Thrown where it cannot be followed further.
[[noreturn]] void refuse(const std::string& why) {
  throw std::invalid_argument("no cycle was found: " + why);
}

/// A motion from a state on, step by step.
class Motion {
 public:
  Motion(const Field& field, const Vector& u, const Vector& p, const std::function<bool()>& go_on)
      : field_(field), p_(p), go_on_(go_on), state_(u.begin(), u.end()) {}

  double time() const { return time_; }
  Vector state() const { return Eigen::Map<const Vector>(state_.data(), std::ssize(state_)); }

  Vector velocity(const Vector& u) const {
    Vector result(u.size());
    if (!field_.evaluate(time_, u, p_, {&result}))
      refuse(fmt::format("the equations have no value at t = {:g}", time_));
    return result;
  }

  /// One step, which ends at `end` at the latest.
  void step(double end) {
    if (go_on_ && !go_on_()) throw Unfinished(Stop::interrupted, "ended while a cycle was looked for");
    const auto f = [this](const State& u, State& out, double t) {
      Vector value(std::ssize(u));
      if (!field_.evaluate(t, Eigen::Map<const Vector>(u.data(), std::ssize(u)), p_, {&value}))
        value.setConstant(std::nan(""));
      out.assign(value.begin(), value.end());
    };
    for (int tries = 0; tries < 200; ++tries) {
      length_ = std::min(length_, end - time_);
      const double wanted = length_;
      const auto taken = stepper_.try_step(f, state_, time_, length_);
      if (!std::isfinite(length_)) length_ = 0.1 * wanted;
      if (taken == odeint::success) {
        if (!state().allFinite()) break;
        return;
      }
    }
    refuse(fmt::format("the motion cannot be followed past t = {:g}", time_));
  }

  void go_to(double end) {
    while (time_ < end) step(end);
  }

 private:
  const Field& field_;
  const Vector& p_;
  const std::function<bool()>& go_on_;
  State state_;
  double time_ = 0;
  double length_ = 1e-3;
  odeint::result_of::make_controlled<odeint::runge_kutta_dopri5<State>>::type stepper_ =
      odeint::make_controlled(accuracy, accuracy, odeint::runge_kutta_dopri5<State>());
};

/// What has changed, but for whole turns.
Vector change(const Field& field, const Vector& from, const Vector& to) {
  Vector result = to - from;
  for (Index i = 0; i < result.size(); ++i) {
    if (const double turn = field.turn(i); turn > 0) result(i) = std::remainder(result(i), turn);
  }
  return result;
}

/// After how many periods of the field the motion comes back to where it is; one where it does after none of
/// the first few, as what has not settled.
int periods_of_return(const Field& field, Motion motion, double period) {
  constexpr int most = 8;
  const Vector origin = motion.state();
  const double begun = motion.time();
  Vector low = origin;
  Vector high = origin;
  for (int periods = 1; periods <= most; ++periods) {
    while (motion.time() < begun + periods * period) {
      motion.step(begun + periods * period);
      low = low.cwiseMin(motion.state());
      high = high.cwiseMax(motion.state());
    }
    if (change(field, origin, motion.state()).norm() <= close * (high - low).norm()) return periods;
  }
  return 1;
}

/// The time after which the motion comes back to where it is, found on `motion`, which it is followed by.
double time_of_return(const Field& field, Motion motion, double longest) {
  const Vector origin = motion.state();
  const auto away = [&](const Vector& place) { return change(field, origin, place); };
  const Vector across = motion.velocity(origin).normalized();
  const double begun = motion.time();
  Vector low = origin;
  Vector high = origin;
  double before = 0;
  Vector place_before = origin;
  double time_before = begun;
  while (motion.time() < begun + longest) {
    motion.step(begun + longest);
    const Vector place = motion.state();
    low = low.cwiseMin(place);
    high = high.cwiseMax(place);
    const double ahead = across.dot(away(place));
    if (before < 0 && ahead >= 0) {
      const double part = before / (before - ahead);
      const Vector crossing = place_before + part * (place - place_before);
      if (away(crossing).norm() < close * (high - low).norm())
        return time_before + part * (motion.time() - time_before) - begun;
    }
    before = ahead;
    place_before = place;
    time_before = motion.time();
  }
  refuse(fmt::format("the motion does not come back to where it was at t = {:g} until t = {:g}", begun,
                     begun + longest));
}

}  // namespace

CycleStart settled_cycle(const std::shared_ptr<const Field>& field, const Vector& u, const Vector& p,
                         std::optional<double> given, const CycleOptions& options,
                         const std::function<bool()>& go_on) {
  constexpr double rounds = 50;
  Motion motion(*field, u, p, go_on);
  double period = field->is_periodic() ? field->period(p, nullptr) : 0;
  const double time = given.value_or(rounds * period);
  const double settled = field->is_periodic() ? period * std::ceil(time / period) : time;
  motion.go_to(settled);
  int periods = 1;
  if (field->is_periodic()) {
    periods = periods_of_return(*field, motion, period);
    period *= periods;
  } else {
    if (motion.velocity(motion.state()).norm() * time < 1e-6 * (1 + motion.state().norm()))
      refuse(fmt::format("the motion has come to rest at t = {:g}", time));
    period = time_of_return(*field, motion, time);
  }
  const OrbitMesh fine(rule_for(*field, options.degree), 4 * options.intervals);
  Matrix orbit(field->size(), fine.nodes());
  for (Index node = 0; node < fine.nodes(); ++node) {
    motion.go_to(settled + period * fine.place(node));
    orbit.col(node) = motion.state();
  }
  for (Index i = 0; i < orbit.rows(); ++i) {  // both ends meet, but for whole turns
    double gap = orbit(i, orbit.cols() - 1) - orbit(i, 0);
    const double turn = field->turn(i);
    if (turn > 0) {
      gap = std::remainder(gap, turn);
      orbit.row(i).array() -= turn * std::round(orbit.row(i).mean() / turn);
    }
    for (Index node = 0; node < fine.nodes(); ++node) orbit(i, node) -= gap * fine.place(node);
  }
  const OrbitMesh mesh = options.trigonometric
                             ? options.mesh(*field)
                             : fine.equidistributed(orbit, Vector::Ones(orbit.rows()), options.intervals);
  return cycle_from_orbit(field, mesh, fine.carried(orbit, mesh), period, p, periods);
}

}  // namespace arcslip::continuation
