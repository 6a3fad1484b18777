#include "arcslip/continuation/cycles/collocation_rule.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <boost/math/special_functions/legendre.hpp>
#include <cmath>
#include <stdexcept>

namespace arcslip::continuation {
namespace {

/// P_m and its first two derivatives at x.
struct Legendre {
  double value, first, second;
};

Legendre legendre(int m, double x) {
  const double value = boost::math::legendre_p(m, x);
  const double first = boost::math::legendre_p_prime(m, x);
  return {value, first, (2 * x * first - m * (m + 1) * value) / (1 - x * x)};
}

/// Zeros of P_m, from -1 to 1, and their weights.
void find_gauss(int m, Vector& points, Vector& weights) {
  for (int i = 0; i < m; ++i) {
    double x = -std::cos(pi * (i + 0.75) / (m + 0.5));
    for (int round = 0; round < 8; ++round) x -= legendre(m, x).value / legendre(m, x).first;
    const double slope = legendre(m, x).first;
    points(i) = x;
    weights(i) = 2 / ((1 - x * x) * slope * slope);
  }
}

/// Zeros of P_m - P_{m-1}, the last of which is 1.
void find_radau(int m, Vector& points, Vector& weights) {
  for (int i = 0; i < m; ++i) {
    double x = std::cos(two_pi * (m - 1 - i) / (2 * m - 1));
    for (int round = 0; round < 8 && i < m - 1; ++round) {
      const Legendre high = legendre(m, x);
      const Legendre low = legendre(m - 1, x);
      x -= (high.value - low.value) / (high.first - low.first);
    }
    const double low = m * boost::math::legendre_p(m - 1, x);
    points(i) = x;
    weights(i) = (1 + x) / (low * low);
  }
}

}  // namespace

CollocationRule::CollocationRule(int degree, CollocationPoints points)
    : degree_(degree), nodes_(degree + 1), barycentric_(degree + 1), points_(degree), weights_(degree) {
  if (degree < least || degree > most)
    throw std::invalid_argument(
        fmt::format("collocation: expected a degree from {} to {}, got {}", least, most, degree));
  const int m = degree;
  nodes_(0) = 0;
  nodes_(m) = 1;
  (points == CollocationPoints::gauss ? find_gauss : find_radau)(m, points_, weights_);
  points_ = 0.5 * (1 + points_.array());
  weights_ *= 0.5;
  for (int i = 1; i < m; ++i) {  // zeros of P_m'
    double y = -std::cos(pi * i / m);
    for (int round = 0; round < 8; ++round) y -= legendre(m, y).first / legendre(m, y).second;
    nodes_(i) = 0.5 * (1 + y);
  }
  for (int k = 0; k <= m; ++k) {
    double product = 1;
    for (int l = 0; l <= m; ++l) product *= l == k ? 1 : nodes_(k) - nodes_(l);
    barycentric_(k) = 1 / product;
  }
  highest_ = std::tgamma(m + 1) * barycentric_;
  for (int i = 1; i < 200; ++i) product_ = std::max(product_, std::abs((0.005 * i - nodes_.array()).prod()));
  fill();
}

CollocationRule CollocationRule::trigonometric(int waves) {
  CollocationRule rule;
  const int m = 2 * waves + 1;
  rule.degree_ = m;
  rule.waves_ = waves;
  rule.nodes_ = Vector::LinSpaced(m + 1, 0, 1);
  rule.points_ = rule.nodes_.head(m);
  rule.weights_.setConstant(m, 1.0 / m);
  rule.modes_.setConstant(m, m, 1.0 / m);
  for (int h = 1; h <= waves; ++h) {
    for (int k = 0; k < m; ++k) {
      const double angle = two_pi * (static_cast<long>(h) * k % m) / m;
      rule.modes_(k, 2 * h - 1) = 2.0 / m * std::cos(angle);
      rule.modes_(k, 2 * h) = 2.0 / m * std::sin(angle);
    }
  }
  rule.fill();
  rule.values_.setIdentity();
  return rule;
}

/// At the points, and where one looks.
void CollocationRule::fill() {
  const Index m = degree_;
  values_.resize(m, m + 1);
  derivatives_.resize(m, m + 1);
  Vector value;
  Vector derivative;
  for (Index i = 0; i < m; ++i) {
    at(points_(i), value, &derivative);
    values_.row(i) = value.transpose();
    derivatives_.row(i) = derivative.transpose();
  }
  const Index looks = waves_ > 0 ? 4 * m + 1 : 17;
  looks_.resize(looks, m + 1);
  for (Index i = 0; i < looks; ++i) {
    at(static_cast<double>(i) / static_cast<double>(looks - 1), value);
    looks_.row(i) = value.transpose();
  }
}

Matrix CollocationRule::coefficients(const Matrix& values) const {
  const Vector growth = values.rightCols(1) - values.col(0);
  return (values.leftCols(degree_) - growth * points_.transpose()) * modes_;
}

void CollocationRule::at(double s, Vector& value, Vector* derivative) const {
  const Index count = degree_ + 1;
  value.resize(count);
  if (derivative != nullptr) derivative->resize(count);
  if (waves_ > 0) {
    Matrix basis = Matrix::Zero(degree_, 2);  // and its derivative
    basis(0, 0) = 1;
    for (Index h = 1; h <= waves_; ++h) {
      const double rate = two_pi * static_cast<double>(h);
      const Complex wave = std::polar(1.0, rate * s);
      basis.middleRows(2 * h - 1, 2) << wave.real(), -rate * wave.imag(), wave.imag(), rate * wave.real();
    }
    Matrix weights(count, 2);
    weights.topRows(degree_).noalias() = modes_ * basis;
    weights.bottomRows(1) << s, 1;  // of the value at the end, what grows linearly taken from the others
    weights.bottomRows(1) -= points_.transpose() * weights.topRows(degree_);
    weights.row(0) -= weights.row(degree_);
    value = weights.col(0);
    if (derivative != nullptr) *derivative = weights.col(1);
    return;
  }
  if (derivative == nullptr) {  // products of the factors before and behind each node's
    double before = 1;
    for (Index k = 0; k < count; ++k) {
      value(k) = barycentric_(k) * before;
      before *= s - nodes_(k);
    }
    double behind = 1;
    for (Index k = count; k-- > 0;) {
      value(k) *= behind;
      behind *= s - nodes_(k);
    }
    return;
  }
  for (Index k = 0; k < count; ++k) {
    // product and its derivative, factor by factor
    double product = barycentric_(k);
    double slope = 0;
    for (Index l = 0; l < count; ++l) {
      if (l == k) continue;
      slope = slope * (s - nodes_(l)) + product;
      product *= s - nodes_(l);
    }
    value(k) = product;
    (*derivative)(k) = slope;
  }
}

}  // namespace arcslip::continuation
