// What a user controls: stops, events, observers, restarts.

#include <array>
#include <chrono>
#include <cmath>
#include <thread>

#include "arcslip/continuation/path/trace.hpp"
#include "catch.hpp"
#include "engine_problems.hpp"
#include "same_points.hpp"
#include "scalar_problem.hpp"

using namespace arcslip;
using namespace arcslip::continuation;
using namespace arcslip::testing;

namespace {

/// p = x^3 - 3 x: folds at x = -+1; as many as wanted with p = sin.
ScalarProblem sine() {
  return {{"p"},
          [](double x, const Vector& p) { return std::sin(x) - p(0); },
          [](double x, const Vector&) { return std::cos(x); },
          {[](double, const Vector&) { return -1.0; }}};
}

}  // namespace

TEST_CASE("A branch stops after so many folds, at the first event, and says so") {
  TraceOptions options = over("p", -2, 2);
  options.stop_after = {{PointType::fold, 3, {}}};
  const Branch branch = trace(sine(), {vector_of({0}), vector_of({0}), 0, vector_of({1, 1})}, options);
  CHECK(branch.stop == Stop::requested);
  CHECK(branch.complete());
  const auto folds = of_type(branch, PointType::fold);
  REQUIRE(folds.size() == 3);
  CHECK(branch.points.back().type == PointType::fold);
  CHECK_THAT(folds[2].unknowns(0), WithinRel(2.5 * 3.14159265358979323846, 1e-10));

  options.stop_after = {{PointType::fold, 3, {}}, {PointType::event, 1, "two"}};
  options.events = {{"two", [](const Vector& u, const Vector&, const Regime&) { return u(0) - 2; }}};
  const Branch shorter = trace(sine(), {vector_of({0}), vector_of({0}), 0, vector_of({1, 1})}, options);
  CHECK(shorter.stop == Stop::requested);
  CHECK(shorter.points.back().label == "two");
  CHECK_THAT(shorter.points.back().unknowns(0), WithinRel(2.0, 1e-12));
}

TEST_CASE("User events stand beside folds and listed values in one run") {
  TraceOptions options = over("mu", -2, 2);
  options.stop_at = {-1, 0, 1};
  options.events = {
      {"zero", [](const Vector& u, const Vector&, const Regime&) { return u(0); }},
      {"jump", [](const Vector& u, const Vector&, const Regime&) { return u(0) > 0.3 ? 1.0 : -1.0; }}};
  const Branch branch = trace(Cusp(), {vector_of({-1.5}), vector_of({-2})}, options);
  REQUIRE(branch.complete());
  const auto events = of_type(branch, PointType::event);
  REQUIRE(events.size() == 1);  // a jump has no zero
  CHECK(events[0].label == "zero");
  CHECK_THAT(events[0].unknowns(0), WithinAbs(0, 1e-12));
  CHECK(of_type(branch, PointType::fold).size() == 2);
  CHECK(of_type(branch, PointType::user).size() == 5);  // 0 on all three sheets
}

TEST_CASE("Zeros of a function in pieces are found between its jumps, in whatever steps") {
  const auto p_of = [](const Vector& u) { return u(0); };
  const auto piece_at = [](double p) { return p < 0.21 ? 0 : p < 0.52 ? 1 : p < 0.71 ? 2 : 3; };
  TraceOptions options = over("p", 0, 1);
  options.events = {{"pieces",
                     [&](const Vector& u, const Vector&, const Regime&) {  // jumps at 0.21, 0.52 and 0.71
                       const double p = p_of(u);
                       const std::array values{-1.0, 0.45 - p, 1.0, 0.9 - p};
                       return values[static_cast<std::size_t>(piece_at(p))];
                     },
                     [&](const Vector& u, const Vector&, const Regime&) { return piece_at(p_of(u)); }}};
  const ScalarProblem line(
      {"p"}, [](double u, const Vector& p) { return u - p(0); }, [](double, const Vector&) { return 1; },
      {[](double, const Vector&) { return -1; }});
  for (const double max_step : {0.01, 0.1, 0.3, 1.0}) {
    CAPTURE(max_step);
    options.max_step = max_step;
    const Branch branch = trace(line, {vector_of({0}), vector_of({0})}, options);
    REQUIRE(branch.complete());
    const auto events = of_type(branch, PointType::event);
    REQUIRE(events.size() == 2);
    CHECK_THAT(events[0].unknowns(0), WithinAbs(0.45, 1e-8));
    CHECK(events[0].unknowns(0) >= 0.45);  // just behind
    CHECK_THAT(events[1].unknowns(0), WithinAbs(0.9, 1e-8));
  }
}

TEST_CASE("Zeros of functions in pieces that coincide but for rounding are all found", "[close]") {
  const ScalarProblem line(
      {"p"}, [](double u, const Vector& p) { return u - p(0); }, [](double, const Vector&) { return 1; },
      {[](double, const Vector&) { return -1; }});
  const auto piece_at = [](const Vector& u, const Vector&, const Regime&) { return u(0) < 0.41 ? 0 : 1; };
  for (const double off : {-1e-14, -1e-15, 0.0, 1e-15, 1e-14}) {
    for (const double max_step : {0.003, 0.01, 0.03, 0.1, 0.3, 1.0}) {
      CAPTURE(off, max_step);
      const auto vanishing_at = [](double place) {  // negative but between the jump and the place
        return [place](const Vector& u, const Vector&, const Regime&) {
          return u(0) < 0.41 ? -1 : place - u(0);
        };
      };
      TraceOptions options = over("p", 0, 1);
      options.max_step = max_step;
      options.events = {{"first", vanishing_at(0.45), piece_at},
                        {"second", vanishing_at(0.45 + off), piece_at}};
      const Branch branch = trace(line, {vector_of({0}), vector_of({0})}, options);
      REQUIRE(branch.complete());
      CHECK(of_type(branch, PointType::event).size() == 2);
    }
  }
}

TEST_CASE("A function that touches zero in a step changes its sign there as well") {
  const ScalarProblem line(
      {"p"}, [](double u, const Vector& p) { return u - p(0); }, [](double, const Vector&) { return 1; },
      {[](double, const Vector&) { return -1; }});
  TraceOptions options = over("p", 0, 1);
  for (const double behind : {0.003, 0.02, 0.05}) {
    for (const double touch : {0.3, 0.41, 0.46, 0.5, 0.613}) {
      CAPTURE(behind, touch);
      const double change = touch + behind;
      options.events = {{"touches", [=](const Vector& u, const Vector&, const Regime&) {
                           return (u(0) - touch) * (u(0) - touch) * (u(0) - change);
                         }}};
      const Branch branch = trace(line, {vector_of({0}), vector_of({0})}, options);
      REQUIRE(branch.complete());
      const auto events = of_type(branch, PointType::event);
      REQUIRE(events.size() == 1);
      CHECK_THAT(events[0].unknowns(0), WithinAbs(change, 1e-8));
    }
  }
}

TEST_CASE("Both directions from a start in between make one branch") {
  const Branch both = trace_both(Cusp(), {vector_of({1.2}), vector_of({0.528})}, over("mu", -2, 2));
  CHECK(both.complete());
  CHECK(both.first_stop == Stop::left_range);
  CHECK(of_type(both, PointType::fold).size() == 2);
  CHECK(both.points.front().parameters(0) == -2);
  CHECK(both.points.back().parameters(0) == 2);
  CHECK(both.points.front().arclength < 0);
  for (std::size_t i = 1; i < both.points.size(); ++i)
    CHECK(both.points[i].arclength >= both.points[i - 1].arclength);
  const auto start = of_type(both, PointType::start);
  REQUIRE(start.size() == 1);
  CHECK(start[0].arclength == 0);
}

TEST_CASE("A start may be two corrections of one length off") {
  // steep up to 0, where u = -1 is as far away as the guess is
  const auto root = [](double u) { return std::sqrt(u * u + 1e-6); };
  const ScalarProblem bent(
      {"p"}, [=](double u, const Vector& p) { return u / 40 + 0.5 * (root(u) + u) + 0.025 - p(0); },
      [=](double u, const Vector&) { return 1.0 / 40 + 0.5 * (1 + u / root(u)); },
      {[](double, const Vector&) { return -1.0; }});
  const Guess guess{vector_of({1}), vector_of({0}), 0, vector_of({0, 1})};
  const Branch branch = trace(bent, guess, over("p", 0, 1));
  REQUIRE(branch.stop == Stop::reached_end);
  CHECK_THAT(branch.points.front().unknowns(0), WithinAbs(-1, 1e-4));
}

TEST_CASE("Any stored point is a place to start from again") {
  const Branch branch = trace(Cusp(), {vector_of({-1.5}), vector_of({-2})}, over("mu", -2, 2));
  for (std::size_t i = 1; i + 1 < branch.points.size(); i += 5) {
    const Branch on = trace(Cusp(), restart(branch.points[i]), over("mu", -2, 2));
    CHECK(on.stop == Stop::reached_end);
    CHECK_THAT(on.points.back().unknowns(0), WithinRel(branch.points.back().unknowns(0), 1e-9));
    const Branch back = trace(Cusp(), restart(branch.points[i], false), over("mu", -2, 2));
    CHECK(back.stop == Stop::left_range);
    CHECK_THAT(back.points.back().unknowns(0), WithinRel(branch.points.front().unknowns(0), 1e-9));
  }
}

TEST_CASE("The observer sees each point once, in order, and may end the branch") {
  std::vector<double> seen;
  const Branch branch =
      trace(Cusp(), {vector_of({-1.5}), vector_of({-2})}, over("mu", -2, 2), [&](const BranchPoint& point) {
        seen.push_back(point.arclength);
        return seen.size() < 9;
      });
  CHECK(branch.stop == Stop::interrupted);
  REQUIRE(branch.points.size() == seen.size());
  for (std::size_t i = 0; i < seen.size(); ++i) CHECK(branch.points[i].arclength == seen[i]);
  CHECK(branch.checkpoint);
}

TEST_CASE("A branch that is told to end does so before the next evaluation, wherever it stands") {
  const Guess guess{vector_of({-1.5}), vector_of({-2})};
  TraceOptions options = over("mu", -2, 2);
  options.stop_at = {0.3};
  const Branch whole = trace(Cusp(), guess, options);
  REQUIRE(whole.complete());
  long resumed = 0;
  for (long allowed = 0;; ++allowed) {
    long asked = 0;
    options.go_on = [&] { return asked++ < allowed; };
    const Branch cut = trace(Cusp(), guess, options);
    if (cut.complete()) break;
    CHECK(asked == allowed + 1);
    CHECK(cut.stop == Stop::interrupted);
    REQUIRE(cut.points.size() <= whole.points.size());
    for (std::size_t i = 0; i < cut.points.size(); ++i) check_same(cut.points[i], whole.points[i]);
    CHECK_THAT(cut.explanation,
               ContainsSubstring(cut.points.empty() ? "before the first point" : "stands at mu"));
    REQUIRE(cut.checkpoint.has_value() == !cut.points.empty());
    if (!cut.checkpoint) continue;
    options.go_on = {};
    const Branch rest = resume(Cusp(), *cut.checkpoint, options);
    CHECK(rest.complete());
    CHECK_THAT(rest.points.back().unknowns(0), WithinRel(whole.points.back().unknowns(0), 1e-9));
    ++resumed;
  }
  CHECK(resumed > whole.work.evaluations / 2);
}

TEST_CASE("Time is limited from the first evaluation on, for all parts of a branch together") {
  long evaluations = 0;
  std::chrono::milliseconds pause(20);
  const ScalarProblem slow{{"p"},
                           [&](double x, const Vector& p) {
                             ++evaluations;
                             std::this_thread::sleep_for(pause);
                             return std::sin(x) - p(0);
                           },
                           [](double x, const Vector&) { return std::cos(x); },
                           {[](double, const Vector&) { return -1.0; }}};
  TraceOptions options = over("p", -0.9, 0.9);
  options.max_seconds = 0.001;
  const Branch first = trace(slow, {vector_of({1}), vector_of({0})}, options);
  CHECK(first.stop == Stop::time_limit);
  CHECK(first.points.empty());
  CHECK(first.explanation == "max_seconds have passed before the first point was found");
  CHECK(evaluations == 1);

  options.max_seconds = 0.5;
  options.max_step = 0.01;
  evaluations = 0;
  const Branch both = trace_both(slow, {vector_of({0}), vector_of({0})}, options);
  CHECK(both.stop == Stop::time_limit);
  CHECK(both.first_stop == Stop::time_limit);
  CHECK(evaluations <= 27);  // as many as half a second has room for, and one more in each part

  // The part back, which had no time to begin, is not forgotten.
  pause = {};
  options.max_seconds = std::numeric_limits<double>::infinity();
  REQUIRE(both.checkpoint);
  const Branch rest = resume(slow, *both.checkpoint, options);
  CHECK(rest.complete());
  CHECK(rest.points.front().parameters(0) == -0.9);
  CHECK(rest.points.back().parameters(0) == 0.9);
}

TEST_CASE("A limit of time ends a branch that would go on") {
  TraceOptions options = over("p", -2, 2);
  options.max_seconds = 0.02;
  options.max_points = 100000000;
  options.bound = 1e300;
  const Branch branch = trace(sine(), {vector_of({0}), vector_of({0}), 0, vector_of({1, 1})}, options);
  CHECK(branch.stop == Stop::time_limit);
  CHECK_FALSE(branch.complete());
  CHECK(branch.points.size() > 10);
}

TEST_CASE("An unknown without limit ends the branch as unbounded") {
  TraceOptions options = over("p", -2, 2);
  options.bound = 50;
  const Branch branch = trace(sine(), {vector_of({0}), vector_of({0}), 0, vector_of({1, 1})}, options);
  CHECK(branch.stop == Stop::unbounded);
  CHECK(std::abs(branch.points.back().unknowns(0)) > 50);
}

TEST_CASE("The same input gives the same branch") {
  const Branch one = trace(Cusp(), {vector_of({-1.5}), vector_of({-2})}, over("mu", -2, 2));
  const Branch two = trace(Cusp(), {vector_of({-1.5}), vector_of({-2})}, over("mu", -2, 2));
  REQUIRE(one.points.size() == two.points.size());
  for (std::size_t i = 0; i < one.points.size(); ++i) check_same(one.points[i], two.points[i]);
}
