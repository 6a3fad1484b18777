// Where the highest peak of a response is lowest, of responses in closed form.

#include "arcslip/problems/ridges/highest_peak.hpp"

#include <cmath>
#include <memory>

#include "catch.hpp"
#include "scalar_problem.hpp"

using namespace arcslip;
using namespace arcslip::problems;
using namespace arcslip::testing;
using Catch::Matchers::WithinAbs;

TEST_CASE("The highest peak is lowest beside a jump, where a part of the response splits off") {
  // (u - g)((u - 3)^2 + (a - 2)^2 - 1) + (b - 1)/5 = 0: for b < 1 the response goes over a circle, with a
  // peak above 4, for b > 1 below it, with that of g, which grows with b.
  const auto hump = [](double a) { return 1 / (1 + 25 * (a - 0.5) * (a - 0.5)); };
  const auto above = [=](double u, const Vector& p) { return u - 2.5 - 0.3 * p(1) * p(1) * hump(p(0)); };
  const auto circle = [](double u, const Vector& p) {
    return (u - 3) * (u - 3) + (p(0) - 2) * (p(0) - 2) - 1;
  };
  const auto value = [=](double u, const Vector& p) { return above(u, p) * circle(u, p) + 0.2 * (p(1) - 1); };
  const auto by_u = [=](double u, const Vector& p) { return circle(u, p) + 2 * (u - 3) * above(u, p); };
  const auto by_a = [=](double u, const Vector& p) {
    const double h = hump(p(0));
    return 15 * p(1) * p(1) * (p(0) - 0.5) * h * h * circle(u, p) + 2 * (p(0) - 2) * above(u, p);
  };
  const auto by_b = [=](double u, const Vector& p) { return -0.6 * p(1) * hump(p(0)) * circle(u, p) + 0.2; };
  PeakedResponse response;
  response.problem = std::make_shared<ScalarProblem>(
      std::vector<std::string>{"a", "b"}, value, by_u,
      std::vector{ScalarProblem::Function(by_a), ScalarProblem::Function(by_b)});
  response.along = "a";
  response.across = "b";
  response.from = 0.1;
  response.to = 4;
  response.objective = "u";
  response.start = {vector_of({2.56}), vector_of({0.1, 1}), {}, {}};
  response.options = over("a", 0.1, 4);
  ResponsePeaks peaks(response);
  HighestPeak highest(peaks, 0.5, 2, {});
  const HighestPeak::Lowest lowest = highest.lowest();
  CHECK(lowest.kind == OptimumKind::jump);
  CHECK_THAT(highest.value(lowest.x), WithinAbs(1, 1e-6));
  CHECK_THAT(highest.sample(lowest.x).highest().log_height, WithinAbs(std::log(2.8), 1e-6));
  CHECK_THAT(std::exp(lowest.low), WithinAbs(0.5, 1e-6));  // there it is less than twice as high
}
