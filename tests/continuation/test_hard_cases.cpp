// Branches that are hard to trace: each passes, or ends with its true reason.

#include <cmath>

#include "catch.hpp"
#include "engine_problems.hpp"
#include "scalar_problem.hpp"

using namespace arcslip;
using namespace arcslip::continuation;
using namespace arcslip::testing;

namespace {

/// p = f(x).
ScalarProblem graph(std::function<double(double)> f, std::function<double(double)> slope) {
  return {{"p"},
          [f](double x, const Vector& p) { return f(x) - p(0); },
          [slope](double x, const Vector&) { return slope(x); },
          {[](double, const Vector&) { return -1.0; }}};
}

/// Regime 0 (x < 0): p = -x^2 + 2 gap x, a fold at x = gap beyond the border x = 0 for gap > 0, before it for
/// gap < 0. Regime 1 (x > 0): p = slope x.
class CornerNextToFold : public Corner {
 public:
  CornerNextToFold(double gap, double slope) : Corner(0, slope), gap_(gap), slope_(slope) {}
  bool evaluate(const Vector& u, const Vector& p, const Regime& regime,
                const Evaluation& out) const override {
    const double x = u(0);
    if (out.residual != nullptr)
      (*out.residual)(0) = p(0) - (regime == 0 ? -x * x + 2 * gap_ * x : slope_ * x);
    if (out.jacobian != nullptr) (*out.jacobian)(0, 0) = regime == 0 ? 2 * x - 2 * gap_ : -slope_;
    if (out.parameter_jacobian != nullptr) (*out.parameter_jacobian)(0, 0) = 1;
    return true;
  }

 private:
  double gap_, slope_;
};

}  // namespace

TEST_CASE("A fold of very high curvature is passed") {
  const double curvature = GENERATE(1e2, 1e4, 1e6, 1e8);
  CAPTURE(curvature);
  // p = sqrt(1/c^2 + x^2) - 1/c is a hyperbola with p'' = c at x = 0 and slope 1 far from it
  const double r = 1 / curvature;
  const ScalarProblem problem =
      graph([r](double x) { return std::hypot(r, x); }, [r](double x) { return x / std::hypot(r, x); });
  const Branch branch = trace(problem, {vector_of({-1}), vector_of({std::hypot(r, 1)})}, over("p", 1, -1));
  CHECK(branch.stop == Stop::left_range);
  const auto folds = of_type(branch, PointType::fold);
  REQUIRE(folds.size() == 1);
  CHECK_THAT(folds[0].parameters(0), WithinAbs(r, 1e-10));
  CHECK_THAT(folds[0].unknowns(0), WithinAbs(0, 1e-10));
  CHECK_THAT(branch.points.back().unknowns(0), WithinRel(std::sqrt(1 - r * r), 1e-9));
  CHECK(branch.points.size() < 300);
}

TEST_CASE("Two folds very near to one another are both found") {
  const double half = GENERATE(1e-2, 1e-4, 5e-7);
  CAPTURE(half);
  // p = x^3/3 - half^2 x has its folds at x = -+half
  const ScalarProblem problem = graph([=](double x) { return x * x * x / 3 - half * half * x; },
                                      [=](double x) { return x * x - half * half; });
  const Branch branch =
      trace(problem, {vector_of({-1}), vector_of({0})}, over("p", -1.0 / 3 + half * half, 0.3));
  REQUIRE(branch.complete());
  const auto folds = of_type(branch, PointType::fold);
  REQUIRE(folds.size() == 2);
  CHECK_THAT(folds[0].unknowns(0), WithinAbs(-half, 1e-10));
  CHECK_THAT(folds[1].unknowns(0), WithinAbs(half, 1e-10));
}

TEST_CASE("A fold that lies 1e-8 before a corner, or would lie 1e-8 behind it, is told from the corner") {
  const double slope = GENERATE(2.0, -2.0);
  SECTION("before") {
    const CornerNextToFold problem(-1e-8, slope);
    const Branch branch = trace(problem, {vector_of({-1}), vector_of({-1})}, over("p", -1, 1));
    const auto folds = of_type(branch, PointType::fold);
    REQUIRE(folds.size() == 1);
    CHECK_THAT(folds[0].unknowns(0), WithinAbs(-1e-8, 1e-10));
    CHECK(of_type(branch, PointType::regime_switch).size() == 1);
    // behind the fold the parameter falls, so that a rising piece turns it at the corner
    CHECK(of_type(branch, PointType::corner_fold).size() == (slope > 0 ? 1 : 0));
    CHECK(branch.stop == (slope > 0 ? Stop::reached_end : Stop::left_range));
  }
  SECTION("behind") {
    const CornerNextToFold problem(1e-8, slope);
    const Branch branch = trace(problem, {vector_of({-1}), vector_of({-1})}, over("p", -1, 1));
    CHECK(of_type(branch, PointType::fold).empty());
    CHECK(of_type(branch, PointType::regime_switch).size() == 1);
    CHECK(of_type(branch, PointType::corner_fold).size() == (slope < 0 ? 1 : 0));
    CHECK(branch.stop == (slope > 0 ? Stop::reached_end : Stop::left_range));
  }
}

TEST_CASE("A corner that another branch leaves is passed, and found as a branch point", "[corner]") {
  // v - 2 v for |v| < p - 1/2, v -+ (2 p - 1) beyond: besides v = 0 there are |v| = 2 p - 1 from the corner
  // on.
  const auto wide = [](const Vector& p) { return std::max(p(0) - 0.5, 0.0); };
  const ScalarProblem bent(
      {"p"}, [=](double v, const Vector& p) { return v - 2 * std::clamp(v, -wide(p), wide(p)); },
      [=](double v, const Vector& p) { return std::abs(v) < wide(p) ? -1.0 : 1.0; },
      {[=](double v, const Vector& p) {
        return wide(p) == 0 || std::abs(v) < wide(p) ? 0.0 : v > 0 ? -2.0 : 2.0;
      }});
  for (const double max_step : {0.01, 0.03, 0.1, 0.3}) {
    for (const double from : {0.0, 0.0123, 0.31}) {
      for (const bool backwards : {false, true}) {
        CAPTURE(max_step, from, backwards);
        TraceOptions options = backwards ? over("p", 1, from) : over("p", from, 1);
        options.max_step = max_step;
        const Branch branch = trace(bent, {vector_of({0}), vector_of({options.from})}, options);
        CAPTURE(branch.explanation);
        CHECK(branch.stop == Stop::reached_end);
        const auto found = of_type(branch, PointType::branch_point);
        REQUIRE(found.size() == 1);
        CHECK_THAT(found[0].parameters(0), WithinAbs(0.5, 1e-12));
      }
    }
  }
}

TEST_CASE("Branches that all but cross are kept apart, whatever the steps are") {
  // u^2 = (p - 0.4137)^2 + gap^2 differs from two lines that cross by the gap squared, in units of 0.4137
  // squared.
  const double gap = std::pow(10, GENERATE(range(-4.9, -2.9, 0.1)));
  const double max_step = GENERATE(0.01, 0.03, 0.1, 0.3);
  CAPTURE(gap, max_step);
  const auto way = [](const Vector& p) { return p(0) - 0.4137; };
  const ScalarProblem problem(
      {"p"}, [=](double u, const Vector& p) { return u * u - way(p) * way(p) - gap * gap; },
      [](double u, const Vector&) { return 2 * u; }, {[=](double, const Vector& p) { return -2 * way(p); }});
  TraceOptions options = over("p", 0, 1);
  options.max_step = max_step;
  const Branch branch = trace(problem, {vector_of({0.4137}), vector_of({0})}, options);
  CHECK(branch.complete());
  CHECK(of_type(branch, PointType::branch_point).empty());
  CHECK_THAT(branch.points.back().unknowns(0), WithinRel(std::hypot(1 - 0.4137, gap), 1e-9));
}

TEST_CASE("A special point at the very end value is found, and the branch ends there") {
  SECTION("a fold") {
    const ScalarProblem problem = graph([](double x) { return 1 - x * x; }, [](double x) { return -2 * x; });
    const Branch branch = trace(problem, {vector_of({-1}), vector_of({0})}, over("p", 0, 1));
    CHECK(branch.stop == Stop::reached_end);
    CHECK_THAT(branch.points.back().unknowns(0), WithinAbs(0, 1e-5));  // sqrt of the value's rounding
    CHECK_THAT(branch.points.back().parameters(0), WithinAbs(1, 1e-10));
  }
  SECTION("a branch point") {
    const ScalarProblem problem(
        {"p"}, [](double x, const Vector& p) { return x * (p(0) - x * x); },
        [](double x, const Vector& p) { return p(0) - 3 * x * x; },
        {[](double x, const Vector&) { return x; }});
    const Branch branch = trace(problem, {vector_of({0}), vector_of({-1})}, over("p", -1, 0));
    CHECK(branch.stop == Stop::reached_end);
    CHECK(of_type(branch, PointType::branch_point).size() == 1);
    CHECK_THAT(branch.points.back().parameters(0), WithinAbs(0, 1e-10));
  }
}

TEST_CASE("A vertical branch is followed until its unknown leaves all bounds") {
  const ScalarProblem problem = graph([](double) { return 0.5; }, [](double) { return 0.0; });
  TraceOptions options = over("p", 0, 1);
  options.bound = 100;
  const Branch branch = trace(problem, {vector_of({0}), vector_of({0.5}), 0, vector_of({1, 0})}, options);
  CHECK(branch.stop == Stop::unbounded);
  for (const BranchPoint& point : branch.points) CHECK_THAT(point.parameters(0), WithinAbs(0.5, 1e-12));
}

TEST_CASE("A piece that is vertical only in the middle is passed") {
  // x^3 = p: infinite slope dx/dp at 0, without a fold
  const ScalarProblem problem = graph([](double x) { return x * x * x; }, [](double x) { return 3 * x * x; });
  const Branch branch = trace(problem, {vector_of({-1}), vector_of({-1})}, over("p", -1, 1));
  REQUIRE(branch.stop == Stop::reached_end);
  CHECK(of_type(branch, PointType::fold).empty());
  CHECK_THAT(branch.points.back().unknowns(0), WithinRel(1.0, 1e-10));
}

TEST_CASE("A branch that starts on a singular point goes on, or says why it cannot") {
  SECTION("on a fold") {
    const ScalarProblem problem = graph([](double x) { return x * x; }, [](double x) { return 2 * x; });
    const Branch branch = trace(problem, {vector_of({0}), vector_of({0})}, over("p", 0, 1));
    CHECK(branch.stop == Stop::reached_end);
    CHECK_THAT(std::abs(branch.points.back().unknowns(0)), WithinRel(1.0, 1e-10));
  }
  SECTION("on a branch point") {
    const ScalarProblem problem(
        {"p"}, [](double x, const Vector& p) { return x * (p(0) - x * x); },
        [](double x, const Vector& p) { return p(0) - 3 * x * x; },
        {[](double x, const Vector&) { return x; }});
    const Branch branch = trace(problem, {vector_of({0}), vector_of({0})}, over("p", 0, 1));
    CHECK(branch.stop == Stop::reached_end);
  }
  SECTION("where there is no solution") {
    const ScalarProblem problem = graph([](double x) { return x * x; }, [](double x) { return 2 * x; });
    const Branch branch = trace(problem, {vector_of({0}), vector_of({-1})}, over("p", -1, 1));
    CHECK(branch.stop == Stop::no_start);
    CHECK(branch.points.empty());
    CHECK_FALSE(branch.explanation.empty());
  }
}

TEST_CASE("A residual that turns nan ends the branch at the last good point") {
  const ScalarProblem problem = graph([](double x) { return x > 0.7 ? std::nan("") : x * x * x + x; },
                                      [](double x) { return 3 * x * x + 1; });
  const Branch branch = trace(problem, {vector_of({0}), vector_of({0})}, over("p", 0, 5));
  CHECK(branch.stop == Stop::no_value);
  CHECK_FALSE(branch.complete());
  CHECK_THAT(branch.points.back().unknowns(0), WithinAbs(0.7, 1e-8));
  for (const BranchPoint& point : branch.points) CHECK(point.residual <= 1e-9);
}

TEST_CASE("A start is found from a guess from which whole corrections lead away") {
  const ScalarProblem problem =
      graph([](double x) { return std::atan(x); }, [](double x) { return 1 / (1 + x * x); });
  const double far = GENERATE(1.4, 3.0, 30.0);
  CAPTURE(far);
  const Branch branch = trace(problem, {vector_of({far}), vector_of({0})}, over("p", 0, 1));
  CHECK(branch.stop == Stop::reached_end);
  CHECK_THAT(branch.points.front().unknowns(0), WithinAbs(0, 1e-10));
  const Branch none = trace(problem, {vector_of({far}), vector_of({2})}, over("p", 2, 1));
  CHECK(none.stop == Stop::no_start);
  CHECK(none.points.empty());
}
