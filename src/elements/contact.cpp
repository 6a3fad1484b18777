#include "arcslip/elements/contact.hpp"

#include <cmath>
#include <numbers>

namespace arcslip {
namespace {

/// theta - sin(2 theta)/2 without cancellation: below 1/2 by the series of the sine.
double segment(double theta) {
  if (theta > 0.5) return theta - 0.5 * std::sin(2 * theta);
  const double square = 4 * theta * theta;
  double term = 2 * theta * square / 6;
  double sum = term;
  for (int k = 5; std::abs(term) > 1e-17 * sum; k += 2) {
    term *= -square / ((k - 1) * k);
    sum += term;
  }
  return 0.5 * sum;
}

}  // namespace

HarmonicCoefficient slip_coefficient(double log_ratio) {
  constexpr double inverse_pi = std::numbers::inv_pi;
  const double x = std::exp(-log_ratio);
  const double rest = -std::expm1(-log_ratio);  // 1 - x
  const double imaginary = 4 * inverse_pi * x * rest;
  const double imaginary_log = -4 * inverse_pi * x * (rest - x);
  if (rest <= 0) return {{1, imaginary}, {0, imaginary_log}};
  const double theta = 2 * std::atan2(std::sqrt(x), std::sqrt(rest));  // theta* = arccos(1 - 2x)
  const double real_log = -8 * inverse_pi * x * std::sqrt(x * rest);
  return {{inverse_pi * segment(theta), imaginary}, {real_log, imaginary_log}};
}

HarmonicCoefficient hysteresis_coefficient(double amplitude, double slip_threshold) {
  if (amplitude <= slip_threshold) return {{1, 0}, {0, 0}};
  return slip_coefficient(std::log1p((amplitude - slip_threshold) / slip_threshold));
}

SlipFraction slip_fraction(double log_ratio) {
  if (!(log_ratio > 0)) return {0, 0};
  const double x = std::exp(-log_ratio);
  const double rest = -std::expm1(-log_ratio);
  return {2 * std::numbers::inv_pi * std::atan2(std::sqrt(rest), std::sqrt(x)),
          std::numbers::inv_pi * std::sqrt(x / rest)};
}

double dissipated_energy(double log_ratio) { return log_ratio > 0 ? 4 * std::expm1(log_ratio) : 0; }

}  // namespace arcslip
