// Stops beyond a clearance: the describing function in closed form, harmonics and derivatives of several
// stop_orders against samples in time and differences.

#include <cmath>
#include <random>
#include <vector>

#include "arcslip/elements/element_kind.hpp"
#include "catch.hpp"

using namespace arcslip;

namespace {

constexpr double stiffness = 3.0;
constexpr double gap = 0.8;

std::shared_ptr<const Element> stops() { return find_element_kind("clearance")->make({{stiffness, gap}, 1}); }

double force_of(double x) { return stiffness * std::copysign(std::max(std::abs(x) - gap, 0.0), x); }

HarmonicVector some_motion(unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  HarmonicVector x(4);
  for (Index a = 0; a < 4; ++a) x(a) = Complex(normal(random), normal(random)) / static_cast<double>(a + 1);
  return x * (1.7 / std::abs(x(0)));
}

const std::vector<int> stop_orders = {1, 3, 5, 9};

double motion_at(const HarmonicVector& x, double theta) {
  double sum = 0;
  for (Index a = 0; a < x.size(); ++a)
    sum += std::real(x(a) * std::polar(1.0, stop_orders[static_cast<std::size_t>(a)] * theta));
  return sum;
}

ElementForce force_under(const HarmonicVector& x) {
  ElementForce force;
  stops()->force(stop_orders, x, 1, true, true, force);
  return force;
}

}  // namespace

TEST_CASE("Stops are known by their name, with their settings", "[elements]") {
  REQUIRE(find_element_kind("clearance") != nullptr);
  CHECK(find_element_kind("clearance")->settings.size() == 2);
  CHECK(find_element_kind("nothing") == nullptr);
  CHECK(stops()->threshold(7) == gap);
  CHECK(stops()->threshold_by_log_load() == 0);
}

TEST_CASE("Stops under one harmonic have the describing function of a dead zone", "[elements]") {
  const double A = GENERATE(0.8, 0.8000001, 0.81, 1.0, 2.0, 50.0);
  HarmonicVector x(1);
  x << std::polar(A, 0.7);
  ElementForce force;
  stops()->force(std::vector{1}, x, 1, true, true, force);
  const double q = std::min(1.0, gap / A);
  const double share = 1 - 2 / pi * (std::asin(q) + q * std::sqrt(1 - q * q));
  CHECK(std::abs(force.harmonics(0) - stiffness * share * x(0)) < 2e-14 * stiffness * A);
  CHECK(force.energy == 0);
  CHECK_THAT(force.swing.peak(), Catch::Matchers::WithinRel(A, 1e-15));
}

TEST_CASE("Harmonics of stops are those of their force in time", "[elements]") {
  const HarmonicVector x = some_motion(GENERATE(1U, 2U, 3U, 4U));
  const ElementForce force = force_under(x);
  constexpr int samples = 200000;  // the force has kinks: an error of 1/samples^2
  for (Index a = 0; a < x.size(); ++a) {
    Complex sum = 0;
    for (int k = 0; k < samples; ++k) {
      const double theta = two_pi * (k + 0.5) / samples;
      sum += force_of(motion_at(x, theta)) *
             std::polar(2.0 / samples, -stop_orders[static_cast<std::size_t>(a)] * theta);
    }
    CHECK(std::abs(force.harmonics(a) - sum) < 1e-8 * force.harmonics.norm());
  }
}

TEST_CASE("First and second derivatives of stops are those of differences", "[elements]") {
  const HarmonicVector x = some_motion(GENERATE(5U, 6U, 7U));
  const HarmonicVector way = some_motion(8);
  constexpr double h = 1e-5;
  const ElementForce here = force_under(x);
  const ElementForce above = force_under(x + h * way);
  const ElementForce below = force_under(x - h * way);
  const HarmonicVector slope = here.linear * way + here.conjugate * way.conjugate();
  CHECK(((above.harmonics - below.harmonics) / (2 * h) - slope).norm() < 1e-8 * slope.norm());
  const ElementForce change = stops()->change(here, stop_orders, x, 1, true, {way, 0.4});
  CHECK(((above.linear - below.linear) / (2 * h) - change.linear).norm() < 1e-6 * change.linear.norm());
  CHECK(((above.conjugate - below.conjugate) / (2 * h) - change.conjugate).norm() <
        1e-6 * change.linear.norm());
  CHECK(change.by_log_load.isZero(0));
}

TEST_CASE("Within their clearance stops do nothing", "[elements]") {
  const HarmonicVector x = 0.1 * some_motion(9);
  for (const bool beyond : {false, true}) {
    ElementForce force;
    stops()->force(stop_orders, x, 1, beyond, true, force);
    CHECK(force.harmonics.norm() == 0);
    CHECK(force.linear.norm() == 0);
  }
  CHECK(stops()->stiffness_in_time(stop_orders, x).bound() == 0);
}

TEST_CASE("Disturbances meet stops while the motion is beyond the clearance", "[elements]") {
  const HarmonicVector x = some_motion(GENERATE(10U, 11U));
  const VaryingStiffness found = stops()->stiffness_in_time(stop_orders, x);
  Complex mean = 0;
  Complex fourth = 0;
  constexpr int samples = 100000;
  for (int k = 0; k < samples; ++k) {
    const double theta = two_pi * (k + 0.5) / samples;
    const double expected = std::abs(motion_at(x, theta)) > gap ? stiffness : 0;
    if (k % 1000 == 0) CHECK(found.at(theta - 2 * pi) == expected);
    mean += expected / samples;
    fourth += expected * std::polar(1.0 / samples, -4 * theta);
  }
  CHECK(std::abs(found.coefficient(0) - mean) < 1e-3);
  CHECK(std::abs(found.coefficient(4) - fourth) < 1e-3);
  CHECK(std::abs(found.coefficient(-4) - std::conj(fourth)) < 1e-3);
  CHECK(found.coefficient(3) == 0.0);
}
