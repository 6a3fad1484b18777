#include "elements/circle/circle_motion.hpp"

#include <stdexcept>
#include <utility>

#include "arcslip/motion/swing.hpp"

namespace arcslip {
namespace {

/// Adds sign x^2, by coefficients.
void add_square(const ComplexVector& x, double sign, ComplexVector& sum) {
  const Index highest = x.size() - 1;
  const auto at = [&](Index h) {  // of both signs
    return h == 0 ? x(0) : h > 0 ? 0.5 * x(h) : 0.5 * std::conj(x(-h));
  };
  for (Index h = 0; h <= 2 * highest; ++h) {
    Complex part = 0;
    for (Index a = h - highest; a <= highest; ++a) part += at(a) * at(h - a);
    sum(h) += sign * (h == 0 ? 1.0 : 2.0) * part;
  }
}

PeriodicMotion pressing(const PressedSettings& settings, const PeriodicMotion& closing) {
  ComplexVector n = settings.normal_stiffness * closing.coefficients();
  n(0) += settings.normal_force;
  return PeriodicMotion(std::move(n));
}

}  // namespace

CircleMotion::CircleMotion(const PressedSettings& settings, const PeriodicMotion& x, const PeriodicMotion& y,
                           const PeriodicMotion& closing)
    : settings_(settings),
      x_(x),
      y_(y),
      closing_(closing),
      press_(pressing(settings, closing)),
      mean_(settings.tangential_stiffness * Complex(x.coefficients()(0).real(), y.coefficients()(0).real())),
      wx_(settings.tangential_stiffness * x.coefficients()),
      wy_(settings.tangential_stiffness * y.coefficients()),
      b_(settings.friction * press_.coefficients()) {
  if (!(settings.tangential_stiffness > 0 && settings.friction >= 0 && settings.normal_stiffness >= 0))
    throw std::invalid_argument(
        "CircleMotion: the tangential stiffness must be positive, friction and normal stiffness not "
        "negative");
  wx_(0) = wy_(0) = 0;
  square_.setZero(2 * highest() + 1);
  add_square(wx_, 1, square_);
  add_square(wy_, 1, square_);
  add_square(b_, -1, square_);
  size_ = wx_.lpNorm<1>() + wy_.lpNorm<1>() + b_.lpNorm<1>();
}

CircleMotion CircleMotion::of(const PressedSettings& settings, std::span<const int> orders,
                              const ComplexVector& motion) {
  const Index n = std::ssize(orders);
  if (n == 0 || (motion.size() != 2 * n && motion.size() != 3 * n))
    throw std::invalid_argument("circle_force: two or three motions of at least one order");
  if (!(settings.friction > 0)) throw std::invalid_argument("circle_force: friction must be positive");
  const int highest = highest_order(orders);
  const auto part = [&](Index which) {
    return which < motion.size() / n ? PeriodicMotion(orders, motion.segment(which * n, n), highest)
                                     : PeriodicMotion(ComplexVector::Zero(highest + 1));
  };
  return {settings, part(0), part(1), part(2)};
}

CircleMotion CircleMotion::tightened(double less) const {
  PressedSettings settings = settings_;
  settings.normal_force -= less / settings.friction;
  return {settings, x_, y_, closing_};
}

CircleMotion::Local CircleMotion::at(double theta) const {
  const Complex turn = std::polar(1.0, theta);
  double cosine = 1;  // of h theta
  double sine = 0;
  Local sum{0, 0, 0, b_(0).real(), 0, 0};
  for (Index h = 1; h < b_.size(); ++h) {
    const double before = cosine;
    cosine = before * turn.real() - sine * turn.imag();
    sine = before * turn.imag() + sine * turn.real();
    const auto order = static_cast<double>(h);
    const auto here = [&](Complex own) { return own.real() * cosine - own.imag() * sine; };
    const auto rate = [&](Complex own) { return -order * (own.real() * sine + own.imag() * cosine); };
    const Complex centre(here(wx_(h)), here(wy_(h)));
    sum.centre += centre;
    sum.rate += Complex(rate(wx_(h)), rate(wy_(h)));
    sum.bend -= order * order * centre;
    const double radius = here(b_(h));
    sum.radius += radius;
    sum.radius_rate += rate(b_(h));
    sum.radius_bend -= order * order * radius;
  }
  return sum;
}

PeriodicMotion CircleMotion::excess(Complex offset, double more) const {
  ComplexVector sum = square_;
  sum.head(wx_.size()) -= 2 * offset.real() * wx_ + 2 * offset.imag() * wy_ + 2 * more * b_;
  sum(0) += std::norm(offset) - more * more;
  return PeriodicMotion(std::move(sum));
}

}  // namespace arcslip
