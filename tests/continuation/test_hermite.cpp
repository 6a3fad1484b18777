#include "arcslip/continuation/path/hermite.hpp"

#include <cmath>

#include "catch.hpp"

using namespace arcslip;
using arcslip::continuation::Hermite;

namespace {

/// Of s^k for k = 0 ... 7, or of their roots' powers.
Vector powers(double x) {
  Vector all(8);
  for (Index k = 0; k < 8; ++k) all(k) = std::pow(x, static_cast<double>(k));
  return all;
}

Vector slopes(double x) {
  Vector all = Vector::Zero(8);
  for (Index k = 1; k < 8; ++k) all(k) = static_cast<double>(k) * std::pow(x, static_cast<double>(k - 1));
  return all;
}

}  // namespace

TEST_CASE("A polynomial through k places with their slopes meets those of order 2 k - 1") {
  Hermite curve;
  for (const double s : {0.0, 1.0, -0.7, 2.5}) curve.add(s, powers(s), slopes(s));
  for (std::size_t places = 2; places <= 4; ++places) {
    for (const double s : {-0.3, 0.4, 1.9}) {
      Vector found;
      curve.at(s, places, found);
      const auto met = static_cast<Index>(2 * places);
      CAPTURE(places, s);
      CHECK((found - powers(s)).head(met).lpNorm<Eigen::Infinity>() < 1e-11);
      if (met < 8) CHECK(std::abs(found(met) - powers(s)(met)) > 1e-3);
    }
  }
}

TEST_CASE("Terms that a place adds are no less than the difference that it makes") {
  Hermite curve;
  for (const double s : {0.0, 1.0, -0.7, 2.5}) curve.add(s, powers(s), slopes(s));
  for (const std::size_t places : {std::size_t{3}, std::size_t{4}}) {
    Vector before, behind, added;
    curve.at(0.4, places - 1, before);
    curve.at(0.4, places, behind);
    curve.added(0.4, places, added);
    CHECK((added.array() >= (behind - before).array().abs() - 1e-15).all());
  }
}

TEST_CASE("From a corner powers of the root are met, with the corner among the places or beside them") {
  // z = s^(k/2), k = 0, 2, 3, 4, 5: without a root of s itself, its slope at the corner is finite.
  const double corner = 0.3;
  const double into = GENERATE(1.0, -1.0);
  const auto value = [&](double s) {
    const double x = std::sqrt(into * (s - corner));
    Vector z(5);
    z << 1, x * x, x * x * x, std::pow(x, 4), std::pow(x, 5);
    return z;
  };
  const auto slope = [&](double s) {
    const double x = std::sqrt(into * (s - corner));
    Vector z(5);
    z << 0, 1, 1.5 * x, 2 * x * x, 2.5 * x * x * x;
    return Vector(into * z);
  };
  const bool holds_corner = GENERATE(true, false);
  Hermite curve(Hermite::Corner{corner, into});
  for (const double way : {holds_corner ? 0.0 : 0.02, 1.0, 0.5}) {
    const double s = corner + into * way;
    curve.add(s, value(s), slope(s));
  }
  for (const double way : {0.1, 0.3, 0.8}) {
    const double s = corner + into * way;
    Vector found;
    curve.at(s, 3, found);
    CAPTURE(into, holds_corner, way);
    CHECK((found - value(s)).lpNorm<Eigen::Infinity>() < 1e-12);
  }
}
