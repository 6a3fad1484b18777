#include "arcslip/elements/memoryless.hpp"

#include <random>
#include <vector>

#include "catch.hpp"

using namespace arcslip;

namespace {

HarmonicVector random_motion(Index count, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  HarmonicVector x(count);
  for (Index a = 0; a < count; ++a)
    x(a) = Complex(normal(random), normal(random)) / static_cast<double>(a + 1);
  return x;
}

/// int f(x(t)) e^{-jh theta} dtheta/pi over a period, by many samples.
Complex sampled(double coefficient, const std::vector<int>& orders, const HarmonicVector& x, int h) {
  constexpr int samples = 4096;
  Complex sum = 0;
  for (int k = 0; k < samples; ++k) {
    const double theta = 2 * std::numbers::pi * k / samples;
    double here = 0;
    for (Index a = 0; a < x.size(); ++a)
      here += std::real(x(a) * std::polar(1.0, orders[static_cast<std::size_t>(a)] * theta));
    sum += coefficient * here * here * here * std::polar(2.0 / samples, -h * theta);
  }
  return sum;
}

}  // namespace

TEST_CASE("A cubic spring's first harmonic alone is 3/4 k_3 |x|^2 x", "[elements]") {
  const auto cubic = cubic_spring(2.5, 1);
  const Element& spring = *cubic;
  const HarmonicVector x = random_motion(1, 1);
  ElementForce force;
  spring.force(std::vector{1}, x, 1, false, true, force);
  CHECK(std::abs(force.harmonics(0) - 0.75 * 2.5 * std::norm(x(0)) * x(0)) <
        1e-15 * std::abs(force.harmonics(0)) * 10);
  CHECK(force.energy == 0);
}

TEST_CASE("A cubic spring's harmonics are those of its force in time, whichever there are", "[elements]") {
  const std::vector<int> orders =
      GENERATE(values<std::vector<int>>({{1, 3}, {1, 5, 7}, {1, 3, 5, 7, 9, 31}}));
  const auto cubic = cubic_spring(0.7, 3);
  const Element& spring = *cubic;
  const HarmonicVector x = random_motion(std::ssize(orders), 2);
  ElementForce force;
  spring.force(orders, x, 1, false, true, force);
  for (Index a = 0; a < x.size(); ++a) {
    const int h = orders[static_cast<std::size_t>(a)];
    CHECK(std::abs(force.harmonics(a) - sampled(0.7, orders, x, h)) < 1e-13 * force.harmonics.norm());
  }
}

TEST_CASE("A cubic spring's derivatives are those of differences", "[elements]") {
  const std::vector<int> orders = {1, 3, 7};
  const auto cubic = cubic_spring(0.7, 3);
  const Element& spring = *cubic;
  const HarmonicVector x = random_motion(3, 3);
  ElementForce force;
  ElementForce above;
  ElementForce below;
  spring.force(orders, x, 1, false, true, force);
  for (Index l = 0; l < 3; ++l) {
    for (const Complex direction : {Complex(1, 0), Complex(0, 1)}) {
      constexpr double h = 1e-5;  // a cubic: differences are off by h^2
      HarmonicVector moved = x;
      moved(l) += h * direction;
      spring.force(orders, moved, 1, false, false, above);
      moved(l) -= 2 * h * direction;
      spring.force(orders, moved, 1, false, false, below);
      const HarmonicVector difference = (above.harmonics - below.harmonics) / (2 * h);
      const HarmonicVector exact =
          force.linear.col(l) * direction + force.conjugate.col(l) * std::conj(direction);
      CHECK((difference - exact).norm() < 1e-9 * force.linear.norm());
    }
  }
}

TEST_CASE("A cubic spring's second derivatives are those of differences", "[elements]") {
  const std::vector<int> orders = {1, 3, 7};
  const auto cubic = cubic_spring(0.7, 3);
  const Element& spring = *cubic;
  const HarmonicVector x = random_motion(3, 4);
  const HarmonicVector direction = random_motion(3, 5);
  constexpr double h = 1e-5;  // of a quadratic: differences are off by rounding alone
  const auto at = [&](double step) {
    ElementForce force;
    spring.force(orders, x + step * direction, 1, false, true, force);
    return force;
  };
  const ElementForce change = spring.change(at(0), orders, x, 1, false, {direction, 0.3});
  const ElementForce above = at(h);
  const ElementForce below = at(-h);
  CHECK(((above.linear - below.linear) / (2 * h) - change.linear).norm() < 1e-9 * change.linear.norm());
  CHECK(((above.conjugate - below.conjugate) / (2 * h) - change.conjugate).norm() <
        1e-9 * change.linear.norm());
  CHECK(((above.harmonics - below.harmonics) / (2 * h) - change.harmonics).norm() <
        1e-8 * change.harmonics.norm());
  CHECK(change.by_log_load.isZero(0));
}
