// Values of the parameter on which a branch is to put points.

#include <algorithm>
#include <cmath>

#include "arcslip/continuation/path/trace.hpp"
#include "catch.hpp"
#include "engine_problems.hpp"
#include "flow.hpp"
#include "scalar_problem.hpp"

using namespace arcslip;
using namespace arcslip::continuation;
using namespace arcslip::testing;

TEST_CASE("Values that coincide but for rounding have a point each") {
  const double apart = GENERATE(2e-17, 1e-13, 1e-11, 1e-9);
  CAPTURE(apart);
  TraceOptions options = over("p", 0, 2);
  for (int i = 0; i < 500; ++i) options.stop_at.push_back(0.1 + i * apart);
  for (const double value : {2 - apart, apart}) options.stop_at.push_back(value);
  std::sort(options.stop_at.begin(), options.stop_at.end());
  options.stop_at.erase(std::unique(options.stop_at.begin(), options.stop_at.end()), options.stop_at.end());
  std::erase(options.stop_at, 2);
  const Branch branch = trace(line("p", 1e-3), {vector_of({0}), vector_of({0})}, options);
  REQUIRE(branch.complete());
  const auto points = of_type(branch, PointType::user);
  REQUIRE(points.size() == options.stop_at.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    CHECK(points[i].parameters(0) == options.stop_at[i]);
    CHECK_THAT(points[i].unknowns(0), WithinRel(1e3 * options.stop_at[i], 1e-12));
  }
}

TEST_CASE("Values around a fold have a point on either side, or on the fold") {
  // p = 1 - x^2, from x = -1 to 1.
  const ScalarProblem arch(
      {"p"}, [](double x, const Vector& p) { return 1 - x * x - p(0); },
      [](double x, const Vector&) { return -2 * x; }, {[](double, const Vector&) { return -1.0; }});
  const double gap = GENERATE(-1e-12, 0.0, 1e-15, 1e-12, 3e-11, 1e-9);
  CAPTURE(gap);
  TraceOptions options = over("p", 0, 1.5);
  options.stop_at = {0.5, 1 - gap, 1 - gap - 1e-11};
  const Branch branch = trace(arch, {vector_of({-1}), vector_of({0})}, options);
  CHECK(branch.stop == Stop::left_range);
  CHECK(of_type(branch, PointType::fold).size() == 1);
  long near = 0;
  for (const BranchPoint& point : of_type(branch, PointType::user)) {
    near += static_cast<long>(point.parameters(0) > 0.9);
    CHECK_THAT(point.unknowns(0) * point.unknowns(0), WithinAbs(1 - point.parameters(0), 1e-12));
  }
  CHECK(near == (gap > 1e-13 ? 4 : 3));
}

namespace {

/// A problem of one unknown whose scales are its own values.
class Relative : public ScalarProblem {
 public:
  Relative(bool unknown, bool parameter, ScalarProblem problem)
      : ScalarProblem(std::move(problem)), unknown_(unknown), parameter_(parameter) {}
  void scale(const Vector& u, const Vector& p, Vector& unknowns, Vector& parameters) const override {
    ScalarProblem::scale(u, p, unknowns, parameters);
    if (unknown_) unknowns = u.cwiseAbs();
    if (parameter_) parameters = p.cwiseAbs();
  }

 private:
  bool unknown_;
  bool parameter_;
};

void check_approach(const Problem& problem, double at, bool beyond) {
  CAPTURE(at, beyond);
  TraceOptions options = over("p", at + 1, beyond ? at - 1 : at);
  if (beyond) options.stop_at = {at};
  const Branch branch = trace(problem, {vector_of({1}), vector_of({at + 1})}, options);
  INFO(branch.explanation);
  CHECK(branch.stop == Stop::asymptotic);
  CHECK_FALSE(branch.complete());
  CHECK_THAT(branch.explanation, ContainsSubstring("comes ever nearer to p = "));
  CHECK(branch.points.size() < 1000);
  CHECK(branch.work.evaluations < 10000);
}

}  // namespace

TEST_CASE("A value that a branch only approaches ends it soon, and the reason is told") {
  const auto minus_one = [](double, const Vector&) { return -1.0; };
  const bool beyond = GENERATE(false, true);
  for (const double at : {0.0, 1.0, -3.0}) {
    const ScalarProblem exponential(
        {"p"}, [=](double x, const Vector& p) { return at + std::exp(1 - x) - p(0); },
        [](double x, const Vector&) { return -std::exp(1 - x); }, {minus_one});
    check_approach(exponential, at, beyond);
    const ScalarProblem hyperbola(
        {"p"}, [=](double x, const Vector& p) { return (p(0) - at) * x - 1; },
        [=](double, const Vector& p) { return p(0) - at; }, {[](double x, const Vector&) { return x; }});
    check_approach(hyperbola, at, beyond);
    const ScalarProblem parabola(
        {"p"}, [=](double x, const Vector& p) { return at + x * x - p(0); },
        [](double x, const Vector&) { return 2 * x; }, {minus_one});
    check_approach(Relative(true, false, parabola), at, beyond);
  }
  const ScalarProblem logarithm(
      {"p"}, [](double x, const Vector& p) { return x - 1 + std::log(p(0)); },
      [](double, const Vector&) { return 1.0; }, {[](double, const Vector& p) { return 1 / p(0); }});
  check_approach(Relative(false, true, logarithm), 0, false);
}

TEST_CASE("0 is reached also in a scale that shrinks with the parameter") {
  const Branch branch =
      trace(Relative(false, true, line("p", 2)), {vector_of({5}), vector_of({10})}, over("p", 10, 0));
  CHECK(branch.complete());
  CHECK(branch.points.back().parameters(0) == 0);
  CHECK(branch.points.back().unknowns(0) == 0);
  CHECK(branch.points.size() < 1000);
}

namespace {

/// u = 1 - (p - place)^2.
ScalarProblem hill(double place) {
  return {{"p"},
          [=](double u, const Vector& p) { return u - 1 + std::pow(p(0) - place, 2); },
          [](double, const Vector&) { return 1.0; },
          {[=](double, const Vector& p) { return 2 * (p(0) - place); }}};
}

std::vector<PointType> last_types(const Branch& branch, std::size_t count) {
  std::vector<PointType> types;
  for (std::size_t i = branch.points.size() - count; i < branch.points.size(); ++i)
    types.push_back(branch.points[i].type);
  return types;
}

}  // namespace

TEST_CASE("A special point on the end of a range is told once, on either side of it by rounding") {
  constexpr double place = 1.3;
  const double off = GENERATE(-1e-9, -3e-11, -1e-13, -2.3e-16, 0.0, 2.3e-16, 1e-13, 3e-11, 1e-9);
  const double way = GENERATE(-1.0, 1.0);
  CAPTURE(off, way);
  const double end = place + off;
  const bool is_passed = way * off >= 0;
  const std::size_t told = is_passed || std::abs(off) < 1e-10 ? 1 : 0;
  const auto check = [&](const Problem& problem, double from_u, const TraceOptions& options, PointType type,
                         const Regime& regime = {}) {
    const Branch branch =
        trace(problem, {vector_of({from_u}), vector_of({options.from}), regime, {}}, options);
    CHECK(branch.complete());
    CHECK(of_type(branch, type).size() == told);
    for (const BranchPoint& point : of_type(branch, type))
      CHECK_THAT(point.parameters(0), WithinAbs(options.to - off, 1e-10));
    CHECK(branch.points.back().type == PointType::end);
    CHECK_THAT(branch.points.back().parameters(0), WithinAbs(options.to, 1e-10));
    if (told == 1) CHECK(last_types(branch, 2).front() == type);
  };
  TraceOptions peak = over("p", place - way, end);
  peak.extrema_of = {"u"};
  check(hill(place), 0, peak, PointType::peak);
  TraceOptions smooth = over("p", place - way, end);
  smooth.events = {{"zero", [](const Vector&, const Vector& p, const Regime&) { return p(0) - place; }}};
  check(line("p", 1), place - way, smooth, PointType::event);
  TraceOptions pieces = smooth;
  pieces.events[0].piece = [](const Vector&, const Vector& p, const Regime&) { return p(0) > place ? 1 : 0; };
  check(line("p", 1), place - way, pieces, PointType::event);
  check(Corner(1, 3), way > 0 ? -1 : 1, over("p", way > 0 ? -1 : 3, off), PointType::regime_switch,
        way > 0 ? 0 : 1);
}

TEST_CASE("A fold on the end of a range is told once, on either side of it by rounding") {
  const ScalarProblem arch(
      {"p"}, [](double x, const Vector& p) { return 1 - x * x - p(0); },
      [](double x, const Vector&) { return -2 * x; }, {[](double, const Vector&) { return -1.0; }});
  const double off = GENERATE(-3e-11, -1e-12, -1e-14, -2.3e-16, 0.0, 2.3e-16, 1e-12, 3e-11);
  CAPTURE(off);
  const Branch branch = trace(arch, {vector_of({-1}), vector_of({0})}, over("p", 0, 1 + off));
  INFO(branch.explanation);
  CHECK(branch.stop == Stop::reached_end);
  CHECK(of_type(branch, PointType::fold).size() == 1);
}

TEST_CASE("A fold on the first value of a range is passed, on either side of it by rounding") {
  const ScalarProblem arch(
      {"p"}, [](double x, const Vector& p) { return 1 - x * x - p(0); },
      [](double x, const Vector&) { return -2 * x; }, {[](double, const Vector&) { return -1.0; }});
  const double off = GENERATE(-3e-11, -1e-12, -1e-14, -2.3e-16, 0.0, 2.3e-16, 1e-14, 1e-12, 3e-11);
  CAPTURE(off);
  const Branch branch =
      trace_both(arch, {vector_of({std::sqrt(0.5)}), vector_of({0.5})}, over("p", 1 + off, 0));
  INFO(branch.explanation);
  CHECK(branch.first_stop == Stop::reached_end);
  CHECK(of_type(branch, PointType::fold).size() == 1);
  CHECK_THAT(branch.points.front().unknowns(0), WithinAbs(-1, 1e-9));
}

TEST_CASE("A zero of a function of pieces where a branch starts is told once, whatever the last digit") {
  const double off = GENERATE(-1e-11, -1e-13, -2.3e-16, 0.0, 2.3e-16, 1e-13, 1e-11);
  const double end = GENERATE(-1.0, 1.0);
  CAPTURE(off, end);
  TraceOptions options = over("p", 0.5 + off, 0.5 + end);
  options.events = {{"zero", [](const Vector&, const Vector& p, const Regime&) { return p(0) - 0.5; },
                     [](const Vector&, const Vector& p, const Regime&) { return p(0) > 0.5 ? 1 : 0; }}};
  const auto told = [&] {
    const Branch branch = trace(line("p", 1), {vector_of({0.5 + off}), vector_of({0.5 + off})}, options);
    CHECK(branch.complete());
    return of_type(branch, PointType::event).size();
  };
  CHECK(told() == 1);
}

TEST_CASE("A pair on the axis where a branch starts is told once, on either side of it by rounding") {
  const auto flow = make_flow(2, {"p"}, [](const auto& u, const auto& p, auto& out) {
    out[0] = p[0] * u[0] - 0.3 * u[1] - u[0] * u[0] * u[0];
    out[1] = p[0] * u[1] + 0.3 * u[0] - u[1] * u[1] * u[1];
  });
  const double off = GENERATE(-1e-12, -1e-14, -2.3e-16, 0.0, 2.3e-16, 1e-14, 1e-12);
  const double end = GENERATE(-1.0, 1.0);
  CAPTURE(off, end);
  const Guess guess{vector_of({0, 0}), vector_of({off}), {}, {}};
  for (const Branch& branch :
       {trace(*flow, guess, over("p", off, end)), trace_both(*flow, guess, over("p", -end, end))}) {
    CHECK(branch.complete());
    CHECK(of_type(branch, PointType::hopf).size() == 1);
    CHECK(branch.points.back().unstable == (end > 0 ? 2 : 0));
  }
}
