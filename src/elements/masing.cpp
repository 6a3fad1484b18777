#include "arcslip/elements/masing.hpp"

#include <cmath>

#include "arcslip/motion/periodic_motion.hpp"
#include "elements/harmonic_turn.hpp"
#include "motion/bracketed_newton.hpp"

namespace arcslip {
namespace {

/// Where the motion turned back, with the force there and its derivatives.
struct Reversal {
  double x;
  double force;
  HarmonicVector turns;      // derivative of x by the x_h
  HarmonicVector by_motion;  // of the force
  double by_setting;
};

/// A settled cycle, integrated as it is followed.
class MasingCycle {
 public:
  MasingCycle(const Backbone& backbone, std::span<const int> orders, const HarmonicVector& x, double load,
              bool derivatives, ElementForce& out)
      : backbone_(backbone),
        motion_(orders, x, highest_order(orders)),
        load_(load),
        derivatives_(derivatives),
        out_(out),
        corners_(backbone.corners()),
        turn_(orders) {}

  void run() {
    const std::vector<double> turns = motion_.derivative().zeros();
    std::size_t first = 0;
    for (std::size_t i = 0; i < turns.size(); ++i) {
      if (std::abs(motion_.value(turns[i])) > std::abs(motion_.value(turns[first]))) first = i;
    }
    begin(turns.empty() ? 0 : turns[first]);
    greatest_ = open_.back();
    for (std::size_t i = 0; i < turns.size(); ++i) {
      const bool wraps = first + i + 1 >= turns.size();
      const double from = turns[(first + i) % turns.size()] + (first + i >= turns.size() ? two_pi : 0);
      const double to = turns[(first + i + 1) % turns.size()] + (wraps ? two_pi : 0);
      pass(from, to);
      if (i + 1 == turns.size()) continue;
      open_.push_back(reversal(to));
      meet(open_.back());
    }
    if (turns.empty()) take(0, two_pi);
  }

  /// The greatest force, which is met where the motion turns back, known once it has run.
  MotionNumber greatest() const {
    const double sign = greatest_.force < 0 ? -1 : 1;
    return {sign * greatest_.force, sign * greatest_.by_motion, 0, sign * greatest_.by_setting};
  }

 private:
  /// Of as great forces to both sides the mean of what they change by.
  void meet(const Reversal& other) {
    constexpr double rounding = 1e-11;
    const double more = std::abs(other.force) - std::abs(greatest_.force);
    if (std::abs(more) > rounding * std::abs(greatest_.force)) {
      if (more > 0) greatest_ = other;
    } else if (other.force * greatest_.force < 0) {
      greatest_.by_motion = 0.5 * (greatest_.by_motion - other.by_motion);
      greatest_.by_setting = 0.5 * (greatest_.by_setting - other.by_setting);
    }
  }

  /// On the backbone.
  void begin(double angle) {
    const double x = motion_.value(angle);
    const double side = x < 0 ? -1 : 1;
    const Jet force = backbone_.force(side * x / load_);
    turn_.go_to(angle);
    open_ = {{x, side * load_ * force.value, turn_.back(), backbone_.slope(side * x / load_) * turn_.back(),
              side * load_ * force.first}};
  }

  /// Where the branch has come to.
  Reversal reversal(double angle) {
    const double x = motion_.value(angle);
    turn_.go_to(angle);
    const Reversal& last = open_.back();
    const double side = x < last.x ? -1 : 1;
    const double half = 0.5 * side * (x - last.x) / load_;
    const Jet force = backbone_.force(half);
    return {x, last.force + side * 2 * load_ * force.value, turn_.back(),
            last.by_motion + backbone_.slope(half) * (turn_.back() - last.turns),
            last.by_setting + side * 2 * load_ * force.first};
  }

  /// From one turning point to the next, closing loops on the way.
  void pass(double from, double to) {
    const double end = motion_.value(to);
    while (open_.size() >= 3) {
      const double level = open_[open_.size() - 2].x;
      if (std::abs(end - open_.back().x) <= std::abs(level - open_.back().x)) break;
      const double closing = crossing(level, from, to);
      take(from, closing);
      open_.resize(open_.size() - 2);
      from = closing;
    }
    take(from, to);
  }

  double crossing(double level, double from, double to) const {
    const auto above = [&](double theta) {
      const PeriodicMotion::Local at = motion_.at(theta);
      return std::pair(at.value - level, at.first);
    };
    return bracketed_newton(above, 0.5 * (from + to), from, to, motion_.value(to) > motion_.value(from));
  }

  /// One branch, between the corners of the backbone.
  void take(double from, double to) {
    const Reversal& last = open_.back();
    const double end = motion_.value(to);
    const double side = end < last.x ? -1 : 1;
    for (const double corner : corners_) {
      const double level = last.x + side * 2 * load_ * corner;
      if (side * (level - motion_.value(from)) <= 0 || side * (end - level) <= 0) continue;
      const double at = crossing(level, from, to);
      integrate(from, at);
      from = at;
    }
    integrate(from, to);
  }

  void integrate(double from, double to) {
    each_gauss_node(from, to, 3 * motion_.highest(),
                    [&](double angle, double weight) { add(angle, weight / two_pi); });
  }

  void add(double angle, double share) {
    const Reversal here = reversal(angle);
    turn_.add_force(share * here.force, out_.harmonics);
    if (!derivatives_) return;
    turn_.add_change(share, here.by_motion, out_.linear, out_.conjugate);
    if (out_.by_setting.size() > 0) turn_.add_force(share * here.by_setting, out_.by_setting);
  }

  const Backbone& backbone_;
  PeriodicMotion motion_;
  double load_;
  bool derivatives_;
  ElementForce& out_;
  std::vector<double> corners_;
  std::vector<Reversal> open_;  // turning points of loops that are not closed, the last one last
  HarmonicTurn turn_;
  Reversal greatest_{};
};

void masing_force(const Backbone& backbone, std::span<const int> orders, const HarmonicVector& x, double load,
                  bool is_varied, bool derivatives, ElementForce& out) {
  const Index n = x.size();
  out.harmonics.setZero(n);
  out.by_setting.setZero(derivatives && is_varied ? n : 0);
  if (derivatives) {
    out.linear.setZero(n, n);
    out.conjugate.setZero(n, n);
  }
  MasingCycle(backbone, orders, x, load, derivatives, out).run();
  out.energy = cycle_energy(orders, out.harmonics, x);
  if (derivatives)  // f is homogeneous in x and the load
    out.by_log_load = out.harmonics - out.linear * x - out.conjugate * x.conjugate();
}

}  // namespace

MasingElement::MasingElement(Made made, double setting_scale)
    : made_(std::move(made)), backbone_(made_(0)), setting_scale_(setting_scale) {}

void MasingElement::force(std::span<const int> orders, const HarmonicVector& x, double load, bool /*beyond*/,
                          bool derivatives, ElementForce& out) const {
  masing_force(*backbone_, orders, x, load, setting_scale_ > 0, derivatives, out);
}

std::vector<MotionNumber> MasingElement::read(std::span<const int> orders, const HarmonicVector& x,
                                              double load, bool /*beyond*/, bool /*derivatives*/) const {
  ElementForce out;
  out.harmonics.setZero(x.size());
  MasingCycle cycle(*backbone_, orders, x, load, false, out);
  cycle.run();
  MotionNumber told = cycle.greatest();
  double by_size = 0;
  for (Index a = 0; a < x.size(); ++a) by_size += std::real(std::conj(told.by_motion(a)) * x(a));
  told.by_log_load = told.value - by_size;  // it is homogeneous in x and the load
  return {told};
}

void MasingElement::second(const ElementForce& /*at*/, std::span<const int> orders, const HarmonicVector& x,
                           double load, bool /*beyond*/, const Way& way, ElementForce& change) const {
  const bool is_varied = setting_scale_ > 0;
  const auto moved = [&](const HarmonicVector& motion, double log_load, double setting, ElementForce& out) {
    const auto backbone = setting == 0 ? backbone_ : made_(setting);
    masing_force(*backbone, orders, motion, load * std::exp(log_load), is_varied, true, out);
  };
  difference(moved, x, way, is_varied ? setting_scale_ : 1, smooth_step, change);
}

}  // namespace arcslip
