#include "arcslip/elements/piecewise_law.hpp"

#include <limits>
#include <stdexcept>

#include "arcslip/elements/memoryless.hpp"
#include "catch.hpp"

using namespace arcslip;
using Catch::Matchers::WithinRel;

namespace {

constexpr double endless = std::numeric_limits<double>::infinity();

/// Linear, then stiffer, then quadratic.
PiecewiseLaw three_pieces() { return PiecewiseLaw({{1, {0, 2}}, {2, {-3, 5}}, {endless, {3, 0, 1}}}); }

}  // namespace

TEST_CASE("A law in pieces is odd and continuous, with its slope, curvature and energy", "[elements]") {
  const PiecewiseLaw law = three_pieces();
  CHECK(law.degree() == 2);
  for (const double x : {0.5, 1.5, 3.0}) {
    const int zone = law.zone_at(x);
    CHECK(law.zone_at(-x) == -zone);
    CHECK(law.value(-x, -zone) == -law.value(x, zone));
    CHECK(law.slope(-x, -zone) == law.slope(x, zone));
    CHECK(law.curvature(-x, -zone) == -law.curvature(x, zone));
    CHECK((law.ends(zone).low <= x && x <= law.ends(zone).high));
    CHECK(law.ends(-zone).low == -law.ends(zone).high);
    constexpr double h = 1e-5;
    CHECK_THAT((law.energy(x + h) - law.energy(x - h)) / (2 * h), WithinRel(law.value(x, zone), 1e-8));
    CHECK_THAT((law.value(x + h, zone) - law.value(x - h, zone)) / (2 * h),
               WithinRel(law.slope(x, zone), 1e-8));
  }
  CHECK(law.energy(-3) == law.energy(3));
}

TEST_CASE("Laws that are no laws are refused", "[elements]") {
  const auto law = [](std::vector<PiecewiseLaw::Piece> pieces) { return PiecewiseLaw(std::move(pieces)); };
  CHECK_THROWS_AS(law({}), std::invalid_argument);
  CHECK_THROWS_AS(law({{1, {0, 1}}}), std::invalid_argument);
  CHECK_THROWS_AS(law({{1, {0, 1}}, {endless, {0, 2}}}), std::invalid_argument);
  CHECK_THROWS_AS(law({{endless, {1, 1}}}), std::invalid_argument);
  CHECK_THROWS_AS(law({{endless, {0, 1, 1}}}), std::invalid_argument);
  CHECK_THROWS_AS(law({{2, {0, 1}}, {1, {0, 1}}, {endless, {0, 1}}}), std::invalid_argument);
  CHECK_THROWS_AS(MemorylessElement(three_pieces(), 0), std::invalid_argument);
}

TEST_CASE("A motion through all pieces of a law has the derivatives of differences", "[elements]") {
  const MemorylessElement element(three_pieces(), 2);
  const std::vector<int> orders = {1, 3};
  HarmonicVector x(2), way(2);
  x << Complex(2.5, 0.3), Complex(0.7, -1.1);
  way << Complex(0.2, -0.4), Complex(-0.3, 0.1);
  const auto at = [&](double step) {
    ElementForce force;
    element.force(orders, x + step * way, 1, true, true, force);
    return force;
  };
  constexpr double h = 1e-5;
  const ElementForce here = at(0);
  const ElementForce change = element.change(here, orders, x, 1, true, {way});
  CHECK(((at(h).harmonics - at(-h).harmonics) / (2 * h) - change.harmonics).norm() <
        1e-8 * change.harmonics.norm());
  CHECK(((at(h).linear - at(-h).linear) / (2 * h) - change.linear).norm() < 1e-6 * change.linear.norm());
  CHECK(((at(h).conjugate - at(-h).conjugate) / (2 * h) - change.conjugate).norm() <
        1e-6 * change.linear.norm());
  const VaryingStiffness stiffness = element.stiffness_in_time(orders, x);
  const OddMotion motion(orders, x);
  for (double theta = -7; theta < 7; theta += 0.173) {
    const double r = motion.value(theta);
    const double slope = element.law()->slope(r, element.law()->zone_at(r));
    CHECK_THAT(stiffness.at(theta), WithinRel(slope, 1e-12));
  }
}

TEST_CASE("A law's derivatives by a setting are those of differences, where its pieces move as well",
          "[elements]") {
  const auto made = [](const Jet& g) {  // continuous at g and 2 g
    return MemorylessElement(
        PiecewiseLaw({{g, {0, 2}}, {2 * g, {-3 * g, 5}}, {endless, {7 * g - 4 * g, 0, 1 / g}}}), 2);
  };
  const std::vector<int> orders = {1, 3};
  HarmonicVector x(2), way(2);
  x << Complex(2.5, 0.3), Complex(0.7, -1.1);
  way << Complex(0.2, -0.4), Complex(-0.3, 0.1);
  const auto at = [&](double step, double setting_step) {
    ElementForce force;
    made({1 + setting_step, 1, 0}).force(orders, x + step * way, 1, true, true, force);
    return force;
  };
  constexpr double h = 1e-5;
  const ElementForce here = at(0, 0);
  const ElementForce up = at(0, h);
  const ElementForce down = at(0, -h);
  CHECK(((up.harmonics - down.harmonics) / (2 * h) - here.by_setting).norm() < 1e-8 * here.by_setting.norm());
  const ElementForce change = made({1, 1, 0}).change(here, orders, x, 1, true, {way, 0, -0.7});
  const ElementForce above = at(h, -0.7 * h);
  const ElementForce below = at(-h, 0.7 * h);
  const auto close = [&](const auto& plus, const auto& minus, const auto& exact) {
    CHECK(((plus - minus) / (2 * h) - exact).norm() < 1e-6 * exact.norm());
  };
  close(above.harmonics, below.harmonics, change.harmonics);
  close(above.linear, below.linear, change.linear);
  close(above.conjugate, below.conjugate, change.conjugate);
  close(above.by_setting, below.by_setting, change.by_setting);

  const auto border = [&](double step) { return made({1 + step, 1, 0}).border(orders, x, nullptr, 1, true); };
  CHECK_THAT((border(h).value - border(-h).value) / (2 * h), WithinRel(border(0).by_setting, 1e-8));
}
