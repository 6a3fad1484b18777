#include <fmt/format.h>

#include <boost/numeric/odeint.hpp>
#include <cmath>
#include <stdexcept>

#include "arcslip/continuation/cycles/piecewise_cycle.hpp"
#include "arcslip/zero_between.hpp"

namespace arcslip::continuation {
namespace {

namespace odeint = boost::numeric::odeint;
using State = std::vector<double>;

/// Thrown where it cannot be followed further.
[[noreturn]] void refuse_pieces(const std::string& why) {
  throw std::invalid_argument("no cycle was found: " + why);
}

/// One piece as it was followed.
struct Followed {
  std::vector<double> times;  // from its begin on
  std::vector<Vector> states;
  std::vector<Vector> velocities;

  /// By a polynomial between two steps.
  Vector at(double time) const {
    std::size_t i = 1;
    while (i + 1 < times.size() && times[i] < time) ++i;
    const double width = times[i] - times[i - 1];
    if (!(width > 0)) return states[i];
    const double x = (time - times[i - 1]) / width;
    const Vector change = states[i] - states[i - 1];
    const Vector from = width * velocities[i - 1];
    const Vector to = width * velocities[i];
    return states[i - 1] + x * (from + x * (3 * change - 2 * from - to + x * (from + to - 2 * change)));
  }
};

/// A motion, piece after piece.
class PieceMotion {
 public:
  PieceMotion(const PiecewiseField& pieces, const Vector& p, double longest)
      : pieces_(pieces), p_(p), longest_(longest) {}

  /// Through a piece from a state up to its border.
  Followed follow(Index piece, const Vector& from) {
    piece_ = piece;
    state_.assign(from.begin(), from.end());
    const auto count = static_cast<std::size_t>(pieces_.size());
    Followed way{{0}, {from}, {velocity(from)}};
    double time = 0;
    double length = first_step(way);
    double before = 0;  // the level of the border, once it is off it
    auto stepper = odeint::make_controlled(accuracy, accuracy, odeint::runge_kutta_dopri5<State>());
    while (true) {
      if (time > longest_)
        refuse_pieces(fmt::format("{} does not come to its border within {:g}", name(), longest_));
      const State last = state_;
      const double begun = time;
      const auto f = [this](const State& u, State& out, double) { rate(u, out); };
      int tries = 0;
      while (stepper.try_step(f, state_, time, length) != odeint::success || !is_finite()) {
        if (++tries > 100)
          refuse_pieces(fmt::format("{} cannot be followed past {:g} of its begin", name(), begun));
        if (!std::isfinite(length) || !is_finite()) {
          length = std::isfinite(length) ? 0.1 * length : first_step(way) * std::pow(0.1, tries);
          state_ = last;
          time = begun;
          stepper.reset();  // it begins with the slope at the end of the last step
        }
      }
      double after = level(state_);
      if (before != 0 && before * after <= 0) {
        odeint::runge_kutta_dopri5<State> again;
        State there(count);
        const auto at = [&](double step) {
          again.reset();
          again.do_step(f, last, begun, there, step);
          return level(there);
        };
        const double step = zero_between(at, 0.0, time - begun, before, after);
        at(step);
        state_ = there;
        time = begun + step;
        after = 0;
      }
      way.times.push_back(time);
      way.states.push_back(here());
      way.velocities.push_back(velocity(here()));
      if (before != 0 && after == 0) return way;
      before = after;
    }
  }

 private:
  static constexpr double accuracy = 1e-9;

  /// On which a state hardly changes: what is shorter would be stepped over.
  static double first_step(const Followed& way) {
    constexpr double hardly = 1e-4;
    const double speed = way.velocities[0].norm();
    return speed > 0 ? hardly * std::max(way.states[0].norm(), hardly) / speed : hardly;
  }

  std::string name() const {
    return fmt::format("the piece {}", pieces_.piece_names()[static_cast<std::size_t>(piece_)]);
  }
  Vector here() const { return Eigen::Map<const Vector>(state_.data(), std::ssize(state_)); }
  bool is_finite() const { return here().allFinite(); }

  Vector velocity(const Vector& u) const {
    Vector result(u.size());
    if (!pieces_.velocity(piece_, u, p_, {&result})) refuse_pieces(name() + " has no value on its way");
    return result;
  }
  void rate(const State& u, State& out) const {
    Vector value(std::ssize(u));
    if (!pieces_.velocity(piece_, Eigen::Map<const Vector>(u.data(), std::ssize(u)), p_, {&value}))
      value.setConstant(std::nan(""));
    out.assign(value.begin(), value.end());
  }
  double level(const State& u) const {
    Vector value(1);
    if (!pieces_.border(piece_, Eigen::Map<const Vector>(u.data(), std::ssize(u)), p_, {&value}))
      refuse_pieces("the border of " + name() + " has no value");
    return value(0);
  }

  const PiecewiseField& pieces_;
  const Vector& p_;
  double longest_;
  Index piece_ = 0;
  State state_;
};

/// Whether a round of pieces ends where it began, as near as a small part of how far it goes.
bool repeats(const PiecewiseField& pieces, const std::vector<Followed>& ways, const Vector& end) {
  constexpr double near_by = 0.02;
  const Vector& begin = ways.front().states.front();
  Vector low = begin;
  Vector high = begin;
  for (const Followed& way : ways) {
    for (const Vector& state : way.states) {
      low = low.cwiseMin(state);
      high = high.cwiseMax(state);
    }
  }
  Vector gap = end - begin;
  for (Index i = 0; i < gap.size(); ++i) {
    if (const double turn = pieces.turn(i); turn > 0) gap(i) = std::remainder(gap(i), turn);
  }
  return gap.norm() <= near_by * (high - low).norm();
}

}  // namespace

OrbitStart settled_pieces(const std::shared_ptr<const PiecewiseField>& pieces, const Vector& u,
                          const Vector& p, std::optional<double> time, const OrbitOptions& options) {
  constexpr double longest = 1e4;  // of one piece, without a time
  constexpr int most = 200;        // pieces, without a time
  const Index n = pieces->size();
  const Index count = pieces->pieces();
  PieceMotion motion(*pieces, p, time.value_or(longest));
  std::vector<Followed> ways(static_cast<std::size_t>(count));
  Vector at = u;
  Vector next(n);
  double passed = 0;
  for (Index followed = 0; followed == 0 || (time ? passed < *time : followed < most); followed += count) {
    for (Index k = 0; k < count; ++k) {
      Followed& way = ways[static_cast<std::size_t>(k)];
      way = motion.follow(k, at);
      passed += way.times.back();
      if (!pieces->jump(k, way.states.back(), p, {&next})) refuse_pieces("a jump has no value");
      at = next;
    }
  }
  if (!repeats(*pieces, ways, at))
    refuse_pieces(fmt::format("the motion does not repeat itself by {:g}; it may need more time", passed));
  const OrbitMesh mesh(CollocationRule(options.degree), options.intervals);
  Matrix orbit((n + 1) * count, mesh.nodes());
  for (Index k = 0; k < count; ++k) {
    const Followed& way = ways[static_cast<std::size_t>(k)];
    const double lasts = way.times.back();
    for (Index node = 0; node < mesh.nodes(); ++node)
      orbit.col(node).segment(n * k, n) = way.at(lasts * mesh.place(node));
    orbit.row(n * count + k).setConstant(lasts);
  }
  return start_from(std::make_shared<PiecewiseCycle>(pieces, mesh, orbit, p), orbit, 1, p);
}

}  // namespace arcslip::continuation
