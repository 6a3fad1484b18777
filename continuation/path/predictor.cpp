#include "arcslip/continuation/path/predictor.hpp"

#include <algorithm>

namespace arcslip::continuation {

Predictor::Predictor(Index size, bool further)
    : further_(further), parabola_(size), twist_(Vector::Zero(size)) {
  bends_.derivatives.fill(twist_);
  next_bends_ = bends_;
}

void Predictor::straighten(Bends& bends) {
  for (Vector& derivative : bends.derivatives) derivative.setZero();
}

/// With derivatives t, b, c and e of z over the arc, a = 1/(normal . t), beta = a normal . b and
/// gamma = a normal . c, those in the step's coordinate s are a t, a^2 (b - beta t) and
/// a^3 (c - 3 beta b + (3 beta^2 - gamma) t): of the cubic of the last step, of length d, that had b in its
/// middle. What it is off at x behind its end is e x^2 (x + d)^2/24.
void Predictor::predict(const Step& step, Vector& displacement) {
  constexpr double far = 3;        // times the last step, where its cubic tells nothing
  constexpr double nearly = 2e-5;  // by how far it ends from a parabola, over its length
  const Vector& t = step.here.tangent;
  const auto& [b, c, e] = bends_.derivatives;
  const double d = bends_.length;
  const double a = 1 / step.normal.dot(t);
  const double s = step.distance;
  const double x = a * s;
  const double in_middle = a * step.normal.dot(b);
  parabola_ = s * step.slope_from + 0.5 * s * s * (a * a * (b - in_middle * t));
  displacement = parabola_;
  if (!further_) return;
  twist_.setZero();
  if (!(x < far * d)) return;
  const double gamma = a * step.normal.dot(c);
  const double beta = in_middle + d / 2 * gamma;
  const double off = x * (x + d);
  twist_ = a * a * a * (c - 3 * beta * (b + d / 2 * c) + (3 * beta * beta - gamma) * t);
  displacement += x * x * d / 4 * (c - gamma * t) + s * s * s / 6 * twist_ +
                  off * off / 24 * (e - a * step.normal.dot(e) * t);
  if (!((displacement - parabola_).norm() < nearly * s * step.slope_from.norm())) displacement = parabola_;
}

/// Of the cubic between the step's ends, or of their slopes where only rounding tells it from a parabola, and
/// of the cubics of the last two steps where these are alike.
void Predictor::learn(const Step& step, double tolerance, bool is_corner) {
  constexpr double rounding = 0.01;  // of the tolerance
  constexpr double alike = 0.5;      // changes of a third derivative, of itself
  constexpr double smooth = 0.1;     // and over a step, of the second one
  const double d = step.distance;
  auto& [bend, twist, change] = next_bends_.derivatives;
  bend = (step.slope_to - step.slope_from) / d;
  const double rate = step.arc_rate();
  next_bends_.length = rate * d;
  const bool straight = (step.slope_to - step.slope_from).norm() < 1e-6 * step.slope_to.norm();
  const bool turns_back = step.slope_to.dot(step.slope_from) < 0;
  if (straight || is_corner || turns_back)
    return straighten(next_bends_);  // rounding, or a corner in between
  const auto scaled = step.here.scale.array() / step.there.scale.array();
  if (further_) {
    twist = 6 / (d * d) * (step.slope_from + step.slope_to - 2 / d * step.chord);
    if (!(d * d * d / 12 * twist.norm() > rounding * tolerance)) twist.setZero();
    change = twist - twist_;
    if (!twist_.isZero(0) && change.norm() < std::max(alike * twist.norm(), smooth / d * bend.norm())) {
      change *= 2 / (d + bends_.length * step.normal.dot(step.here.tangent));
    } else {
      change.setZero();
    }
    twist.array() *= scaled / (rate * rate * rate);
    change.array() *= scaled / (rate * rate * rate * rate);
  }
  bend.array() *= scaled;
  bend /= rate * rate;
}

}  // namespace arcslip::continuation
