#include "arcslip/time/slip_series.hpp"

#include <cmath>

namespace arcslip {

Complex SlipSeries::take(const Complex& rate, double normal_force) {
  const std::size_t m = rate_.size();
  if (m > 0) {
    Complex sum = 0;
    for (std::size_t j = 0; j < m; ++j) sum += turning_[j] * direction_[m - 1 - j];
    direction_.push_back(Complex(0, 1) * sum / static_cast<double>(m));
  }
  rate_.push_back(rate);
  normal_.push_back(normal_force);
  const double per_normal = circle_.stiffness / circle_.friction;
  Complex force = 0;
  double turns = 0;
  for (std::size_t j = 0; j <= m; ++j) {
    force += normal_[j] * direction_[m - j];
    turns += per_normal * std::imag(rate_[j] * std::conj(direction_[m - j]));
    if (j > 0) turns -= normal_[j] * turning_[m - j];
  }
  turning_.push_back(turns / normal_[0]);
  return circle_.friction * force;
}

Vector SlipSeries::slip() const {
  const Index terms = std::ssize(rate_) - 1;
  Vector slip(terms);
  for (Index m = 0; m < terms; ++m) {
    const auto k = static_cast<std::size_t>(m);
    slip(m) = -circle_.friction / circle_.stiffness * static_cast<double>(m + 1) * normal_[k + 1];
    for (std::size_t j = 0; j <= k; ++j) slip(m) += std::real(rate_[j] * std::conj(direction_[k - j]));
  }
  return slip;
}

Vector SlipSeries::settling() const {
  Vector terms = circle_.stiffness / circle_.friction * slip();
  for (Index m = 0; m < terms.size(); ++m) {
    for (Index j = 1; j <= m; ++j) terms(m) -= normal_[static_cast<std::size_t>(j)] * terms(m - j);
    terms(m) /= normal_[0];
  }
  return terms;
}

Complex SlipSeries::direction(double time) const {
  Complex sum = 0;
  for (std::size_t m = direction_.size(); m-- > 0;) sum = sum * time + direction_[m];
  return sum / std::abs(sum);
}

SlipTangent::Step SlipTangent::Step::of(const SlipSeries& series, const RingCircle& circle, double part) {
  Step step{circle, series.direction(), series.turning(), series.settling(), series.direction(part)};
  double power = 1;
  for (std::size_t m = 0; m < step.direction.size(); ++m, power *= part) {
    step.direction[m] *= power;
    step.turning[m] *= power * part;
    if (static_cast<Index>(m) < step.settling.size()) step.settling(static_cast<Index>(m)) *= power * part;
  }
  return step;
}

SlipTangent::SlipTangent(const Step& step, const Row& z_x, const Row& z_y)
    : held_(Row::Zero(z_x.size())),
      memory_(step.direction[0].real() * z_y - step.direction[0].imag() * z_x),
      step_(step) {}

void SlipTangent::take(const Row& x, const Row& y, const Row& g, Row& force_x, Row& force_y) {
  const auto m = std::ssize(motion_x_);
  const RingCircle& circle = step_.circle;
  const double push = circle.friction * circle.normal_stiffness;
  const auto term = [](const auto& terms, Index k) {
    return k < std::ssize(terms) ? terms[static_cast<decltype(terms.size())>(k)] : 0;
  };
  motion_x_.push_back(x);
  motion_y_.push_back(y);
  closing_.push_back(g);
  aside_.emplace_back(-memory_);
  along_.emplace_back(-(push / circle.stiffness) * g);
  held_ += memory_;
  for (Index j = 0; j <= m; ++j) {
    const Complex n = term(step_.direction, m - j);
    const auto k = static_cast<std::size_t>(j);
    aside_.back() += n.real() * motion_y_[k] - n.imag() * motion_x_[k];
    along_.back() += n.real() * motion_x_[k] + n.imag() * motion_y_[k];
  }
  memory_.setZero();
  force_x.setZero(x.size());
  force_y.setZero(x.size());
  for (Index j = 0; j <= m; ++j) {
    const Complex n = term(step_.direction, m - j);
    const auto k = static_cast<std::size_t>(j);
    force_x += push * n.real() * closing_[k] - circle.stiffness * n.imag() * aside_[k];
    force_y += push * n.imag() * closing_[k] + circle.stiffness * n.real() * aside_[k];
    memory_ += term(step_.settling, m - j) * aside_[k] - term(step_.turning, m - j) * along_[k];
  }
  memory_ /= static_cast<double>(m + 1);
}

void SlipTangent::finish(const Row& x, const Row& y, const Row& g, Row& z_x, Row& z_y) const {
  const Complex n = step_.end;
  const RingCircle& circle = step_.circle;
  const Row along =
      n.real() * x + n.imag() * y - (circle.friction * circle.normal_stiffness / circle.stiffness) * g;
  z_x = n.real() * along - n.imag() * held_;
  z_y = n.imag() * along + n.real() * held_;
}

}  // namespace arcslip
