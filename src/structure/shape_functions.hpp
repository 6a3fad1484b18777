#pragma once

// Polynomials on an interval [0, length], and the rule that integrates their products.

#include <Eigen/Core>
#include <array>
#include <boost/math/quadrature/gauss.hpp>
#include <cmath>
#include <utility>

namespace arcslip {

/// Cubic polynomials at s length with their derivatives, for value and slope at the left end, then at the
/// right one.
struct Hermite {
  Eigen::Vector4d value;
  Eigen::Vector4d first;
  Eigen::Vector4d second;

  Hermite(double s, double length) {
    value << 1 - 3 * s * s + 2 * s * s * s, length * (s - 2 * s * s + s * s * s), 3 * s * s - 2 * s * s * s,
        length * (s * s * s - s * s);
    first << (6 * s * s - 6 * s) / length, 1 - 4 * s + 3 * s * s, (6 * s - 6 * s * s) / length,
        3 * s * s - 2 * s;
    second << (12 * s - 6) / (length * length), (6 * s - 4) / length, (6 - 12 * s) / (length * length),
        (6 * s - 2) / length;
  }
};

/// Quartic polynomials at s length with their first derivatives, for the values at the five points of
/// Gauss-Lobatto, from left to right.
struct Quartic {
  static constexpr int count = 5;
  using Values = Eigen::Matrix<double, count, 1>;
  Values value;
  Values first;

  Quartic(double s, double length) {
    const double inner = 0.5 * std::sqrt(3.0 / 7.0);
    const std::array<double, count> at{0, 0.5 - inner, 0.5, 0.5 + inner, 1};
    for (std::size_t i = 0; i < count; ++i) {
      double product = 1;
      double slope = 0;
      for (std::size_t k = 0; k < count; ++k) {
        if (k == i) continue;
        slope = (slope * (s - at[k]) + product) / (at[i] - at[k]);
        product *= (s - at[k]) / (at[i] - at[k]);
      }
      value(static_cast<Eigen::Index>(i)) = product;
      first(static_cast<Eigen::Index>(i)) = slope / length;
    }
  }
};

/// Abscissas on [0, 1] with their weights: exact for polynomials up to degree 11.
inline std::array<std::pair<double, double>, 6> gauss_points() {
  using Rule = boost::math::quadrature::gauss<double, 6>;
  std::array<std::pair<double, double>, 6> all;
  for (std::size_t i = 0; i < 3; ++i) {
    all[2 * i] = {0.5 * (1 - Rule::abscissa()[i]), 0.5 * Rule::weights()[i]};
    all[2 * i + 1] = {0.5 * (1 + Rule::abscissa()[i]), 0.5 * Rule::weights()[i]};
  }
  return all;
}

}  // namespace arcslip
