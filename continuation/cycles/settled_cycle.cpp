#include "arcslip/continuation/cycles/settled_cycle.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <boost/numeric/odeint.hpp>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "arcslip/continuation/path/newton.hpp"

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

/// How far an orbit goes; of one at rest what it is known to.
double reach_of(const Matrix& orbit) {
  const double known = accuracy * (1 + orbit.cwiseAbs().maxCoeff());
  return std::max((orbit.rowwise().maxCoeff() - orbit.rowwise().minCoeff()).norm(), known);
}

/// Whether a cycle begins with a round of the motion that lasts so long, in periods of the field if this has
/// one.
using Serves = std::function<bool(double duration, int periods)>;

/// Offers the rounds after which the motion, in whole periods of the field, comes back to where it is; one
/// period where it does after none of the first few, as what has not settled. Whether one serves.
bool offer_periods(const Field& field, Motion motion, double period, const Serves& serves) {
  constexpr int most = 8;
  const Vector origin = motion.state();
  const double begun = motion.time();
  Vector low = origin;
  Vector high = origin;
  bool comes_back = false;
  for (int periods = 1; periods <= most; ++periods) {
    while (motion.time() < begun + periods * period) {
      motion.step(begun + periods * period);
      low = low.cwiseMin(motion.state());
      high = high.cwiseMax(motion.state());
    }
    if (change(field, origin, motion.state()).norm() > close * (high - low).norm()) continue;
    comes_back = true;
    if (serves(periods * period, periods)) return true;
  }
  return !comes_back && serves(period, 0);
}

/// Offers the rounds after which the motion comes back to where it is. Whether one serves.
bool offer_returns(const Field& field, Motion motion, double longest, const Serves& serves) {
  constexpr int most = 20;
  const Vector origin = motion.state();
  const auto away = [&](const Vector& place) { return change(field, origin, place); };
  const Vector across = motion.velocity(origin).normalized();
  const double begun = motion.time();
  Vector low = origin;
  Vector high = origin;
  double before = 0;
  Vector place_before = origin;
  double time_before = begun;
  int offered = 0;
  while (motion.time() < begun + longest && offered < most) {
    motion.step(begun + longest);
    const Vector place = motion.state();
    low = low.cwiseMin(place);
    high = high.cwiseMax(place);
    const double ahead = across.dot(away(place));
    if (before < 0 && ahead >= 0) {
      const double part = before / (before - ahead);
      const Vector crossing = place_before + part * (place - place_before);
      if (away(crossing).norm() < close * (high - low).norm()) {
        ++offered;
        if (serves(time_before + part * (motion.time() - time_before) - begun, 1)) return true;
      }
    }
    before = ahead;
    place_before = place;
    time_before = motion.time();
  }
  if (offered > 0) return false;
  refuse(fmt::format("the motion does not come back to where it was at t = {:g} until t = {:g}", begun,
                     begun + longest));
}

/// A round of the motion as the start of a cycle.
struct Round {
  CycleStart start;
  double gap;  // by which it misses its begin aside from its way, of how far it goes
};

Round round_of(const std::shared_ptr<const Field>& field, Motion motion, double duration, int periods,
               const Vector& p, const CycleOptions& options) {
  const double begun = motion.time();
  const Vector along = motion.velocity(motion.state()).normalized();
  const OrbitMesh fine(rule_for(*field, options.degree), 4 * options.intervals);
  Matrix orbit(field->size(), fine.nodes());
  for (Index node = 0; node < fine.nodes(); ++node) {
    motion.go_to(begun + duration * fine.place(node));
    orbit.col(node) = motion.state();
  }
  const Vector gap = change(*field, orbit.col(0), orbit.rightCols(1));
  for (Index i = 0; i < orbit.rows(); ++i) {  // both ends meet, but for whole turns
    const double turn = field->turn(i);
    if (turn > 0) orbit.row(i).array() -= turn * std::round(orbit.row(i).mean() / turn);
    for (Index node = 0; node < fine.nodes(); ++node) orbit(i, node) -= gap(i) * fine.place(node);
  }
  const OrbitMesh mesh = options.trigonometric
                             ? options.mesh(*field)
                             : fine.equidistributed(orbit, Vector::Ones(orbit.rows()), options.intervals);
  return {cycle_from_orbit(field, mesh, fine.carried(orbit, mesh), duration, p, periods),
          (gap - gap.dot(along) * along).norm() / reach_of(orbit)};
}

enum class Outcome { cycle, other, too_coarse };

/// Makes the start of a round the cycle that Newton's method finds from it: `other` if that lies elsewhere
/// or, where the motion is not on it already, is not one that a motion settles on. `tolerance` is on the
/// mesh.
Outcome settle(Round& round, double tolerance) {
  constexpr double beside = 0.1;   // of how far the round goes
  constexpr double on_it = 1e-5;   // the same
  constexpr double surely = 1e-4;  // growth in a round: more than the mesh errs by
  const CycleProblem& problem = *round.start.problem;
  Guess& guess = round.start.guess;
  const Solution found = solve(problem, guess);
  if (found.outcome != Correction::converged || problem.mesh_error(found.unknowns, guess.regime) > tolerance)
    return Outcome::too_coarse;
  const Matrix orbit = problem.orbit(guess.unknowns);
  const Matrix off = problem.orbit(found.unknowns) - orbit;
  if (off.colwise().norm().maxCoeff() > beside * reach_of(orbit)) return Outcome::other;
  const ComplexVector logs = problem.log_multipliers(found.unknowns, guess.parameters, guess.regime);
  if (round.gap > on_it && logs.size() > 0 && logs.real().maxCoeff() > surely) return Outcome::other;
  guess.unknowns = found.unknowns;
  return Outcome::cycle;
}

}  // namespace

CycleStart settled_cycle(const std::shared_ptr<const Field>& field, const Vector& u, const Vector& p,
                         std::optional<double> given, const CycleOptions& options,
                         const std::function<bool()>& go_on) {
  constexpr double rounds = 50;
  constexpr int most_looks = 5;
  Motion motion(*field, u, p, go_on);
  const double period = field->is_periodic() ? field->period(p, nullptr) : 0;
  double time = given.value_or(rounds * period);
  if (field->is_periodic()) time = period * std::ceil(time / period);
  std::optional<CycleStart> start;
  const Serves serves = [&](double duration, int periods) {
    CycleOptions on = options;
    while (true) {
      Round round = round_of(field, motion, duration, std::max(1, periods), p, on);
      const bool may_be_finer = !options.trigonometric && 2 * on.intervals <= options.most_intervals;
      const double tolerance = may_be_finer ? options.tolerance : std::numeric_limits<double>::infinity();
      const bool is_taken = periods == 0 || time == 0;  // as what has not settled
      const Outcome outcome = is_taken ? Outcome::cycle : settle(round, tolerance);
      if (outcome == Outcome::too_coarse && may_be_finer) {
        on.intervals *= 2;
        continue;
      }
      if (outcome == Outcome::cycle) start = std::move(round.start);
      return start.has_value();
    }
  };
  for (int looks = 1; looks <= most_looks; ++looks) {
    motion.go_to(looks * time);
    if (!field->is_periodic() &&
        motion.velocity(motion.state()).norm() * time < 1e-6 * (1 + motion.state().norm()))
      refuse(fmt::format("the motion has come to rest at t = {:g}", motion.time()));
    if (field->is_periodic() ? offer_periods(*field, motion, period, serves)
                             : offer_returns(*field, motion, time, serves))
      return *start;
  }
  refuse(fmt::format("by t = {:g} the motion has not settled on the cycles next to it; it may need more time",
                     motion.time()));
}

}  // namespace arcslip::continuation
