#include <algorithm>
#include <boost/math/constants/constants.hpp>
#include <cmath>
#include <numbers>

#include "arcslip/elements/contact.hpp"
#include "arcslip/structure/precise.hpp"
#include "catch.hpp"

using namespace arcslip;

namespace {

struct PreciseCoefficient {
  PreciseReal real, imaginary, real_log, imaginary_log;
};

/// The formulas of the header in fifty digits, in terms of 1 - x = -expm1(-ln(R/S)).
PreciseCoefficient precise_coefficient(double log_ratio) {
  const PreciseReal& pi = boost::math::constants::pi<PreciseReal>();
  const PreciseReal x = exp(PreciseReal(-log_ratio));
  const PreciseReal theta = 2 * asin(sqrt(x));
  return {(theta - sin(2 * theta) / 2) / pi, 4 / pi * x * (1 - x), -8 / pi * x * sqrt(x * (1 - x)),
          -4 / pi * x * (1 - 2 * x)};
}

double relative(double value, const PreciseReal& expected) {
  return static_cast<double>(abs(value - expected) / abs(expected));
}

}  // namespace

TEST_CASE("The slip coefficient and its derivative are accurate to 1e-12 relative from R/S = 1 to 1e12") {
  double worst = 0;
  for (int i = 1; i <= 4000; ++i) {
    const double log_ratio = std::pow(10.0, -14 + 15.45 * i / 4000);  // up to ln 1e12 = 27.6
    const HarmonicCoefficient law = slip_coefficient(log_ratio);
    const PreciseCoefficient exact = precise_coefficient(log_ratio);
    worst = std::max({worst, relative(law.phi.real(), exact.real), relative(law.phi.imag(), exact.imaginary),
                      relative(law.phi_log.real(), exact.real_log)});
    if (std::abs(std::exp(-log_ratio) - 0.5) > 1e-2) {  // d Im phi/d ln R vanishes at R = 2S
      worst = std::max(worst, relative(law.phi_log.imag(), exact.imaginary_log));
    }
  }
  CHECK(worst < 1e-12);
}

TEST_CASE("The coefficients are those of the loop in closed form (Caughey 1960)") {
  // k = 2, slip force 3: S = 1.5; force coefficients k R phi.
  const auto force = [](double amplitude) {
    return 2 * amplitude * hysteresis_coefficient(amplitude, 1.5).phi;
  };
  CHECK_THAT(force(3).real(), WithinRel(3.0, 1e-12));
  CHECK_THAT(force(3).imag(), WithinRel(1.909859317103, 1e-12));
  CHECK_THAT(force(5).real(), WithinRel(2.523157877343, 1e-12));
  CHECK_THAT(force(5).imag(), WithinRel(2.673803043944, 1e-12));
  CHECK_THAT(force(30).real(), WithinRel(1.121582204055, 1e-12));
  CHECK_THAT(force(30).imag(), WithinRel(3.628732702495, 1e-12));
  CHECK_THAT(force(1e30).imag(), WithinRel(4 * 3 / std::numbers::pi, 1e-12));  // full slip: a square wave
}

TEST_CASE("The coefficients are the Fourier integrals of the hysteresis loop") {
  for (const double ratio : {1.05, 1.7, 4.0, 25.0}) {
    // Force over k S at displacement R cos t, t from 0 to pi: elastic down from +1, then sliding at -1
    // [paper, Fig. 5].
    const int steps = 200000;
    Complex sum = 0;
    for (int i = 0; i < steps; ++i) {
      const double t = std::numbers::pi * (i + 0.5) / steps;
      sum += std::max(1 - ratio * (1 - std::cos(t)), -1.0) * Complex(std::cos(t), -std::sin(t));
    }
    const Complex expected = sum * (2.0 / steps) / ratio;
    CHECK(std::abs(hysteresis_coefficient(ratio, 1).phi - expected) < 1e-9);
  }
}

TEST_CASE("Stick is linear, and at R = S the coefficient is continuous and its slope jumps to 4/(pi S)") {
  const HarmonicCoefficient stick = hysteresis_coefficient(0.3, 1);
  CHECK(stick.phi == Complex(1, 0));
  CHECK(stick.phi_log == Complex(0, 0));
  const HarmonicCoefficient corner = slip_coefficient(0);
  CHECK(corner.phi == Complex(1, 0));
  CHECK(corner.phi_log.real() == 0);
  CHECK_THAT(corner.phi_log.imag(), WithinRel(4 / std::numbers::pi, 1e-15));
}

TEST_CASE("The energy of the loop is pi k R^2 Im phi = 4 k S (R - S)") {
  for (const double ratio : {1.0001, 1.5, 2.0, 100.0, 1e8}) {
    const double log_ratio = std::log(ratio);
    const double expected =
        std::numbers::pi * std::exp(2 * log_ratio) * slip_coefficient(log_ratio).phi.imag();
    CHECK_THAT(dissipated_energy(log_ratio), WithinRel(expected, 1e-12));
  }
  CHECK(dissipated_energy(-1) == 0);
  // k = 2, slip force 3 (S = 1.5), X = 5: 42 per cycle.
  CHECK_THAT(2 * 1.5 * 1.5 * dissipated_energy(std::log(5 / 1.5)), WithinRel(42.0, 1e-14));
}
