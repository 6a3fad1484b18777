// The border of stick of friction in a plane, its element, and what coincides.

#include <cmath>
#include <utility>
#include <vector>

#include "arcslip/elements/circle/circle_contact.hpp"
#include "arcslip/elements/element_kind.hpp"
#include "catch.hpp"
#include "draws.hpp"
#include "plane_motions.hpp"

using namespace arcslip;
using namespace arcslip::testing;
using Course = PressedArcs::Course;

namespace {

/// Of a convex function, by golden sections.
template <class Function>
double lowest(const Function& function) {
  constexpr double part = 0.6180339887498949;
  double low = -8, high = 8;
  double left = high - part * (high - low), right = low + part * (high - low);
  double at_left = function(left), at_right = function(right);
  while (high - low > 1e-4) {
    if (at_left < at_right) {
      high = std::exchange(right, left);
      at_right = at_left;
      left = high - part * (high - low);
      at_left = function(left);
    } else {
      low = std::exchange(left, right);
      at_left = at_right;
      right = low + part * (high - low);
      at_right = function(right);
    }
  }
  return std::min(at_left, at_right);
}

}  // namespace

TEST_CASE("The border of stick is the least excess over all places, with exact derivatives", "[circle]") {
  RandomSystems draw(9);
  int near = 0;
  for (const int highest : {1, 3, 7}) {
    for (int i = 0; i < 30; ++i) {
      CAPTURE(highest, i);
      const PressedSettings s = random_pressed(draw);
      const ComplexVector motion = random_motion(draw, highest);
      const std::vector<int> orders = from_zero_to(highest);
      const Index n = highest + 1;
      const CircleRoom room = circle_room(s, orders, motion);
      // no place does better, by a search on samples
      const PeriodicMotion x(orders, motion.head(n), highest), y(orders, motion.segment(n, n), highest),
          g(orders, motion.tail(n), highest);
      std::vector<std::pair<Complex, double>> discs;
      for (int k = 0; k < 500; ++k) {
        const double theta = two_pi * k / 500;
        discs.emplace_back(s.tangential_stiffness * Complex(x.value(theta), y.value(theta)),
                           s.friction * (s.normal_force + s.normal_stiffness * g.value(theta)));
      }
      const auto most = [&](Complex at) {
        double excess = -1e300;
        for (const auto& [w, b] : discs) excess = std::max(excess, std::abs(w - at) - b);
        return excess;
      };
      // convex in each direction
      const double least = lowest([&](double re) {
        return lowest([&](double im) { return most({re, im}); });
      });
      CHECK_THAT(room.excess, WithinAbs(least, 5e-3));
      const ComplexVector way = random_motion(draw, highest);
      const std::vector<double> ds{0.4, -0.3, 0.2, 0.5};
      double exact = 0;
      for (Index a = 0; a < way.size(); ++a) exact += std::real(std::conj(room.by_motion(a)) * way(a));
      for (std::size_t k = 0; k < 4; ++k) exact += ds[k] * room.by[k];
      const auto at = [&](double by) {
        return circle_room(moved(s, ds, by), orders, motion + by * way).excess;
      };
      const double fine = difference(at, 1e-4);
      if (std::abs(fine - difference(at, 5e-5)) > 1e-8) {
        ++near;
        continue;
      }
      CHECK_THAT(exact, WithinAbs(fine, 1e-8));
    }
  }
  CHECK(near < 15);
}

TEST_CASE("The friction circle goes on smoothly where it begins to slip", "[circle]") {
  RandomSystems draw(12);
  const std::vector<int> orders = from_zero_to(3);
  for (int i = 0; i < 20; ++i) {
    CAPTURE(i);
    PressedSettings s{draw.uniform(0.2, 1), draw.uniform(0.5, 2), draw.uniform(0, 0.2), 0};
    ComplexVector motion = random_motion(draw, 3);
    motion(0) = motion(4) = motion(8) = 0;
    if (i % 2 == 0) motion.segment(4, 4) *= 0.3;
    s.normal_force = 3;
    s.normal_force += circle_room(s, orders, motion).excess / s.friction;  // at the border
    REQUIRE(std::abs(circle_room(s, orders, motion).excess) < 1e-12);
    const CircleForce slips = circle_force(s, orders, motion, true, Course::slips);
    const CircleForce sticks = circle_force(s, orders, motion, true, Course::sticks);
    // of a sliding place across the motion the mean changes as the root of the excess, which is rounding
    CHECK((slips.harmonics - sticks.harmonics).norm() < 1e-9);
    CHECK((slips.linear - sticks.linear).norm() > 1e-2);
    // both ways along the normal force: at the very border all, farther off what does not change as a root
    const auto at = [&](double by, Course course = Course::slips) {
      PressedSettings t = s;
      t.normal_force += by;
      return circle_force(t, orders, motion, false, course).harmonics;
    };
    for (const auto& [force, course] : {std::pair(slips, Course::slips), std::pair(sticks, Course::sticks)}) {
      const ComplexVector& by = force.by[PressedForce::normal_force];
      const ComplexVector near = (at(1e-11, course) - at(-1e-11, course)) / 2e-11;
      CHECK((near - by).norm() < 1e-3 * (1 + by.norm()));
    }
    const ComplexVector back = (at(0) - at(-1e-7)) / 1e-7;
    const ComplexVector& by = slips.by[PressedForce::normal_force];
    for (Index c = 0; c < 2; ++c) CHECK((back - by).segment(4 * c + 1, 3).norm() < 2e-3);
  }
}

TEST_CASE("The element of the friction circle has exact derivatives by load and settings", "[circle]") {
  RandomSystems draw(31);
  const ElementKind& kind = *find_element_kind("friction_2d");
  for (const bool closes : {true, false}) {
    const std::vector<int> orders = closes ? std::vector{1, 0, 2, 3} : std::vector{1, 3, 5};
    const auto size = static_cast<Index>(orders.size()) * (closes ? 3 : 2);
    for (int i = 0; i < draws(8); ++i) {
      CAPTURE(closes, i);
      const std::vector<double> values{draw.uniform(0.5, 2), closes ? draw.uniform(0.2, 1) : 0,
                                       draw.uniform(0.1, 0.5), draw.uniform(0, 0.3), draw.uniform(0.5, 1)};
      HarmonicVector x(size), way(size);
      for (Index a = 0; a < size; ++a) {
        const int h = orders[static_cast<std::size_t>(a) % orders.size()];
        x(a) = h == 0 ? draw.uniform(-0.1, 0.1) : std::polar(draw.uniform(0.3, 1) / h, draw.uniform(-pi, pi));
        way(a) = h == 0 ? draw.uniform(-1, 1) : std::polar(draw.uniform(0, 1) / h, draw.uniform(-pi, pi));
      }
      for (std::size_t varied = 0; varied < values.size(); ++varied) {
        if (!closes && varied == 1) continue;
        const auto element = [&](double by) {
          std::vector<Jet> jets(values.begin(), values.end());
          jets[varied] = Jet(values[varied] + by, 1, 0);
          return kind.make({jets, 1, two_pi, closes});
        };
        const auto at = [&](double by, bool beyond) {
          ElementForce out;
          element(0.7 * by)->force(orders, x + by * way, 0.8 * std::exp(0.3 * by), beyond, true, out);
          return out;
        };
        REQUIRE(element(0)->coordinates() == (closes ? 3 : 2));
        const bool sticks = element(0)->border(orders, x, nullptr, 0.8, false).value < 0;
        for (const bool beyond : {true, false}) {
          if (beyond == sticks) continue;  // goes on there in proportion, for correctors on their way
          const ElementForce force = at(0, beyond);
          const HarmonicVector exact = force.linear * way + force.conjugate * way.conjugate() +
                                       0.3 * force.by_log_load + 0.7 * force.by_setting;
          const HarmonicVector near = difference([&](double by) { return at(by, beyond).harmonics; }, 1e-4);
          CHECK((exact - near).norm() < 1e-7 * (1 + exact.norm()));
          const ElementForce second = element(0)->change(force, orders, x, 0.8, beyond, {way, 0.3, 0.7});
          const ComplexMatrix slope = difference([&](double by) { return at(by, beyond).linear; }, 1e-5);
          CHECK((second.linear - slope).norm() < 1e-3 * (1 + slope.norm()));
          const auto border = [&](double by) {
            return element(0.7 * by)->border(orders, x + by * way, nullptr, 0.8 * std::exp(0.3 * by), beyond);
          };
          const MotionNumber here = border(0);
          double slopes = 0.3 * here.by_log_load + 0.7 * here.by_setting;
          for (Index a = 0; a < size; ++a) slopes += std::real(std::conj(here.by_motion(a)) * way(a));
          CHECK_THAT(slopes, WithinAbs(difference([&](double by) { return border(by).value; }, 1e-5), 1e-8));
        }
      }
    }
  }
}

TEST_CASE("The friction circle stands what coincides", "[circle]") {
  const std::vector<int> orders = from_zero_to(2);
  const auto force = [&](PressedSettings s, std::vector<Complex> all, Course course = Course::any) {
    return circle_force(s, orders, Eigen::Map<ComplexVector>(all.data(), 9), true, course);
  };
  // never touches; never moves; pulled for ever; grazes lift-off; slips at the very threshold
  CHECK(force({.5, 1, 1, -2}, {1, 1, 0, 0, 1, 0, 0, 1, 0}).harmonics.norm() == 0);
  CHECK(force({.5, 1, 1, -2}, {1, 1, 0, 0, 1, 0, 0, 1, 0}).apart_fraction == 1);
  const CircleForce rest = force({.5, 1, 1, 2}, {.7, 0, 0, .1, 0, 0, 0, 0, 0});
  CHECK(std::abs(rest.harmonics(0) - 0.7) + std::abs(rest.harmonics(3) - 0.1) < 1e-14);
  const CircleForce pulled = force({.5, 1, 1, 2}, {3, 0, 0, 4, 0, 0, 0, 0, 0});
  CHECK(std::abs(pulled.harmonics(0) - 0.6) + std::abs(pulled.harmonics(3) - 0.8) < 1e-13);
  const CircleForce grazes = force({.5, 1, 1, 1}, {0, 1, 0, 0, Complex(0, .6), 0, 0, 1, 0});
  const CircleForce apart = force({.5, 1, 1, 1 - 1e-9}, {0, 1, 0, 0, Complex(0, .6), 0, 0, 1, 0});
  CHECK(grazes.linear.allFinite());
  CHECK((grazes.harmonics - apart.harmonics).norm() < 1e-6);
  for (const Course course : {Course::sticks, Course::slips}) {
    const CircleForce border = force({.5, 1, 0, 2}, {0, 1, 0, 0, Complex(0, .5), 0, 0, 0, 0}, course);
    CHECK(std::abs(border.harmonics(1) - 1.0) + std::abs(border.harmonics(4) - Complex(0, .5)) < 1e-9);
  }
  // it never moves, on the side of slip
  CHECK(force({.5, 1, 0, 2}, {0, 0, 0, 0, 0, 0, 0, 0, 0}, Course::slips).harmonics.allFinite());
  CHECK_THROWS_AS(force({.5, 0, 0, 4}, {5, 1, 0, 0, 0, 0, 0, 0, 0}), std::invalid_argument);
  CHECK_THROWS_AS(force({0, 1, 0, 4}, {5, 1, 0, 0, 0, 0, 0, 0, 0}), std::invalid_argument);
}
