#include "arcslip/elements/masing.hpp"

#include <boost/math/quadrature/gauss.hpp>
#include <cmath>
#include <stdexcept>

#include "arcslip/motion/periodic_motion.hpp"
#include "motion/bracketed_newton.hpp"

namespace arcslip {
namespace {

/// e^{-jh theta} of each order: the derivative of x(theta) by the x_h.
HarmonicVector turned_back(std::span<const int> orders, double theta) {
  HarmonicVector turns(std::ssize(orders));
  for (Index a = 0; a < turns.size(); ++a)
    turns(a) = std::polar(1.0, -orders[static_cast<std::size_t>(a)] * theta);
  return turns;
}

/// Where the motion turned back, with the force there and its derivatives.
struct Reversal {
  double angle;
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
        orders_(orders),
        motion_(orders, x, highest_order(orders)),
        load_(load),
        derivatives_(derivatives),
        out_(out),
        corners_(backbone.corners()) {}

  void run() {
    const std::vector<double> turns = motion_.derivative().zeros();
    std::size_t first = 0;
    for (std::size_t i = 0; i < turns.size(); ++i) {
      if (std::abs(motion_.value(turns[i])) > std::abs(motion_.value(turns[first]))) first = i;
    }
    begin(turns.empty() ? 0 : turns[first]);
    for (std::size_t i = 0; i < turns.size(); ++i) {
      const bool wraps = first + i + 1 >= turns.size();
      const double from = turns[(first + i) % turns.size()] + (first + i >= turns.size() ? two_pi : 0);
      const double to = turns[(first + i + 1) % turns.size()] + (wraps ? two_pi : 0);
      pass(from, to);
      if (i + 1 < turns.size()) open_.push_back(reversal(to));
    }
    if (turns.empty()) take(0, two_pi);
  }

 private:
  /// On the backbone.
  void begin(double angle) {
    const double x = motion_.value(angle);
    const double side = x < 0 ? -1 : 1;
    const Jet force = backbone_.force(side * x / load_);
    const HarmonicVector turns = turned_back(orders_, angle);
    open_ = {{angle, x, side * load_ * force.value, turns, backbone_.slope(side * x / load_) * turns,
              side * load_ * force.first}};
  }

  /// Where the branch has come to.
  Reversal reversal(double angle) const {
    const double x = motion_.value(angle);
    const HarmonicVector turns = turned_back(orders_, angle);
    const Reversal& last = open_.back();
    const double side = x < last.x ? -1 : 1;
    const double half = 0.5 * side * (x - last.x) / load_;
    const Jet force = backbone_.force(half);
    return {angle,
            x,
            last.force + side * 2 * load_ * force.value,
            turns,
            last.by_motion + backbone_.slope(half) * (turns - last.turns),
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
    using Gauss = boost::math::quadrature::gauss<double, 20>;
    constexpr double longest = 24;  // panel, in radians of the highest harmonic
    if (!(to > from)) return;
    const int panels = static_cast<int>(3 * motion_.highest() * (to - from) / longest) + 1;
    const double half = 0.5 * (to - from) / panels;
    for (int k = 0; k < panels; ++k) {
      const double middle = from + (2 * k + 1) * half;
      for (std::size_t i = 0; i < Gauss::abscissa().size(); ++i) {
        const double weight = Gauss::weights()[i] * half / pi;
        add(middle - Gauss::abscissa()[i] * half, weight);
        add(middle + Gauss::abscissa()[i] * half, weight);
      }
    }
  }

  void add(double angle, double weight) {
    const Reversal here = reversal(angle);
    rows_ = weight * here.turns;
    for (Index a = 0; a < rows_.size(); ++a) {
      if (orders_[static_cast<std::size_t>(a)] == 0) rows_(a) = 0.5 * weight;
    }
    out_.harmonics += here.force * rows_;
    if (!derivatives_) return;
    out_.linear.noalias() += 0.5 * rows_ * here.by_motion.adjoint();
    out_.conjugate.noalias() += 0.5 * rows_ * here.by_motion.transpose();
    if (out_.by_setting.size() > 0) out_.by_setting += here.by_setting * rows_;
  }

  const Backbone& backbone_;
  std::span<const int> orders_;
  PeriodicMotion motion_;
  double load_;
  bool derivatives_;
  ElementForce& out_;
  std::vector<double> corners_;
  std::vector<Reversal> open_;  // turning points of loops that are not closed, the last one last
  HarmonicVector rows_;
};

void masing_force(const Backbone& backbone, std::span<const int> orders, const HarmonicVector& x, double load,
                  bool derivatives, ElementForce& out) {
  const Index n = x.size();
  out.harmonics.setZero(n);
  out.by_setting.setZero(derivatives && backbone.setting_scale() > 0 ? n : 0);
  out.readings.clear();
  if (derivatives) {
    out.linear.setZero(n, n);
    out.conjugate.setZero(n, n);
  }
  MasingCycle(backbone, orders, x, load, derivatives, out).run();
  out.energy = 0;
  for (Index a = 0; a < n; ++a)
    out.energy += pi * orders[static_cast<std::size_t>(a)] * std::imag(out.harmonics(a) * std::conj(x(a)));
  if (derivatives)  // f is homogeneous in x and the load
    out.by_log_load = out.harmonics - out.linear * x - out.conjugate * x.conjugate();
}

}  // namespace

MasingElement::MasingElement(Made made) : made_(std::move(made)), backbone_(made_(0)) {}

void MasingElement::force(std::span<const int> orders, const HarmonicVector& x, double load, bool /*beyond*/,
                          bool derivatives, ElementForce& out) const {
  masing_force(*backbone_, orders, x, load, derivatives, out);
}

VaryingStiffness MasingElement::stiffness_in_time(std::span<const int> /*orders*/,
                                                  const HarmonicVector& /*x*/) const {
  throw std::logic_error("MasingElement: what has a memory has no stiffness in time");
}

void MasingElement::second(const ElementForce& /*at*/, std::span<const int> orders, const HarmonicVector& x,
                           double load, bool /*beyond*/, const Way& way, ElementForce& change) const {
  constexpr double relative = 1e-5;
  const auto moved = [&](const HarmonicVector& motion, double log_load, double setting, ElementForce& out) {
    const auto backbone = setting == 0 ? backbone_ : made_(setting);
    masing_force(*backbone, orders, motion, load * std::exp(log_load), true, out);
  };
  const double scale = backbone_->setting_scale();
  difference(moved, x, way, scale > 0 ? scale : 1, relative, change);
}

}  // namespace arcslip
