// Special points that fall on one another but for rounding.

#include <cmath>

#include "catch.hpp"
#include "scalar_problem.hpp"

using namespace arcslip;
using namespace arcslip::continuation;
using namespace arcslip::testing;

TEST_CASE("An extremum and two events at one place, which is to be landed on, are each found once") {
  for (int i = 0; i < 400; ++i) {
    const double square = 3 + 0.01 * i;  // of the resonance
    const double width = std::pow(10, -2 - i % 5);
    const auto away = [=](double p) { return square - p * p; };
    const auto norm = [=](double p) { return away(p) * away(p) + width * width; };
    const auto slope = [=](double p) { return 2 * p * away(p) / norm(p); };
    const ScalarProblem resonance(
        {"p"}, [=](double u, const Vector& p) { return u + 0.5 * std::log(norm(p(0))); },
        [](double, const Vector&) { return 1.0; }, {[=](double, const Vector& p) { return -slope(p(0)); }});
    TraceOptions options = over("p", 1, 3);
    options.max_points = 1000;
    options.extrema_of = {"u"};
    options.stop_at = {std::sqrt(square)};
    options.events = {
        {"slope", [=](const Vector&, const Vector& p, int) { return slope(p(0)); }},
        {"other", [=](const Vector&, const Vector& p, int) { return away(p(0)) / p(0) / norm(p(0)); }}};
    const Branch branch =
        trace(resonance, {Vector::Constant(1, -0.5 * std::log(norm(1))), vector_of({1})}, options);
    CAPTURE(i, branch.explanation);
    REQUIRE(branch.complete());
    CHECK(of_type(branch, PointType::peak).size() == 1);
    CHECK(of_type(branch, PointType::event).size() == 2);
  }
}
