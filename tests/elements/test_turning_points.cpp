#include <algorithm>
#include <cmath>
#include <vector>

#include "arcslip/motion/arc_integrals.hpp"
#include "arcslip/motion/odd_motion.hpp"
#include "catch.hpp"
#include "motion/bracketed_newton.hpp"
#include "random_systems.hpp"

using namespace arcslip;
using namespace arcslip::testing;

TEST_CASE("Turning points are counted once wherever cells of their search meet", "[harmonics]") {
  // r = cos(theta - a) - b cos 3(theta - a) turns at a, and at two more places for b > 1/9: a goes through a
  // half period in steps that divide those of every search, which begins at one of 8 places
  constexpr int places = 8 * 9 * 5 * 7;
  for (const int highest : {3, 5, 7, 9, 13}) {
    const std::vector<int> orders = odd_up_to(highest);
    for (const double share : {0.05, 0.1, 0.2, 1.0}) {
      for (int place = 0; place < places; ++place) {
        const double a = place * pi / places;
        HarmonicVector r = HarmonicVector::Zero(std::ssize(orders));
        r(0) = std::polar(1.0, -a);
        r(1) = -std::polar(share, -3 * a);
        const Angles found = OddMotion(orders, r).turning_points();
        CAPTURE(highest, share, place);
        REQUIRE(found.count == (share > 1.0 / 9 ? 3 : 1));
        CHECK(std::is_sorted(found.all().begin(), found.all().end()));
        double nearest = 1;
        for (const double angle : found.all())
          nearest = std::min(nearest, std::abs(std::remainder(angle - a, pi)));
        CHECK(nearest < 1e-14);
      }
    }
  }
}

TEST_CASE("The way on from an angle is the change of a motion with its slope", "[harmonics]") {
  const std::vector<int> orders{1, 3, 9, 41};
  RandomSystems draw(5);
  for (int i = 0; i < 200; ++i) {
    HarmonicVector r(4);
    for (Index a = 0; a < 4; ++a) r(a) = std::polar(draw.uniform(0.1, 1), draw.uniform(-pi, pi));
    const OddMotion motion(orders, r);
    const double step = draw.log_uniform(1e-14, 3);
    const OddMotion::Way way = motion.onward(step);
    CAPTURE(i, step);
    CHECK_THAT(way.first, WithinAbs(motion.slopes(step).first, 1e-12));  // of 53 at most
    CHECK_THAT(way.change, WithinAbs(motion.change(0, step), 1e-13 * std::min(1.0, 53 * step)));
    if (step < 1e-10) CHECK_THAT(way.change, WithinAbs(motion.slopes(0.5 * step).first * step, 1e-13 * step));
  }
}

TEST_CASE("Integrals over an arc are exact however short it is", "[harmonics]") {
  RandomSystems draw(13);
  for (int i = 0; i < 100; ++i) {
    const double begin = draw.uniform(-pi, pi);
    const double width = draw.log_uniform(1e-15, pi);
    const ArcIntegrals all(begin, width, 60);
    for (int m = -60; m <= 60; ++m)
      CHECK(std::abs(all[m] - arc_integral(begin, width, m)) < 60 * 1e-15 * width);
  }
}

TEST_CASE("Newton's method between bounds ends at the rounding of a zero", "[harmonics]") {
  // 0.1 -> 3e-4 -> 1e-11 -> rounding for this odd function: none is halved anew.
  RandomSystems draw(17);
  for (int i = 0; i < 1000; ++i) {
    const double zero = draw.uniform(0.3, 3);
    int count = 0;
    const auto sine = [&](double x) {
      ++count;
      return std::pair(std::sin(x - zero) + 1e-3 * std::sin(3 * (x - zero)),
                       std::cos(x - zero) + 3e-3 * std::cos(3 * (x - zero)));
    };
    const double found = bracketed_newton(sine, zero + draw.uniform(-0.1, 0.1), zero - 0.2, zero + 0.2, true);
    CHECK_THAT(found, WithinAbs(zero, 4e-16 * zero + 1e-16));
    CHECK(count <= 4);
  }
}
