#include "arcslip/zero_between.hpp"

#include <cmath>
#include <limits>

#include "catch.hpp"

using arcslip::zero_between;

TEST_CASE("A zero is found between its two sides, in either order") {
  const auto f = [](double x) { return std::exp(x) - 2; };
  CHECK_THAT(zero_between(f, 0, 3, f(0), f(3)), WithinRel(std::log(2.0), 1e-14));
  CHECK_THAT(zero_between(f, 3, 0, f(3), f(0)), WithinRel(std::log(2.0), 1e-14));
  CHECK(zero_between(f, 0, 3, 0, f(3)) == 0);
  CHECK(zero_between(f, 0, 3, f(0), 0) == 3);
}

TEST_CASE("Between values of one sign the smaller one is the zero that has been rounded away") {
  const auto f = [](double) { return 1.0; };
  CHECK(zero_between(f, 1, 2, 3, 1e-17) == 2);
  CHECK(zero_between(f, 1, 2, -1e-17, -3) == 1);
  CHECK(zero_between(f, 2, 1, 3, 1e-17) == 1);
  CHECK(zero_between(f, 1, 1, -1, 1) == 1);
}

TEST_CASE("Values too small to be multiplied have signs all the same") {
  const auto f = [](double x) { return 1e-200 * (x - 0.25); };
  CHECK_THAT(zero_between(f, 0, 1, f(0), f(1)), WithinRel(0.25, 1e-14));
}
