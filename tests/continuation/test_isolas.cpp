// Isolas, and their births and mergers on curves of folds, against closed forms.

#include <cmath>

#include "arcslip/continuation/curves/curve.hpp"
#include "arcslip/continuation/points/fold_problem.hpp"
#include "catch.hpp"
#include "level_set.hpp"

using namespace arcslip;
using namespace arcslip::continuation;
using namespace arcslip::testing;

namespace {

/// u^2 + g(p) = q, with folds at u = 0.
ScalarProblem sheet_over(std::function<double(double)> g, std::function<double(double)> slope) {
  return level_set([=](const Place& z) { return z(0) * z(0) + g(z(1)) - z(2); },
                   [=](const Place& z) { return Place(2 * z(0), slope(z(1)), -1); });
}

/// The curve of folds in q through one at (p, q).
Branch folds_through(const ScalarProblem& problem, double u, double p, double q,
                     const TraceOptions& options) {
  FoldProblem extended(problem, 0);
  return trace_curve(extended, {vector_of({u}), vector_of({p, q}), 0, {}}, options);
}

struct IsolaPlace {
  double u, p, q;
};

/// Checks the only point of a type.
void check_isola(const Branch& curve, PointType type, const IsolaPlace& at) {
  INFO(to_string(type) << ' ' << curve.explanation);
  const auto found = of_type(curve, type);
  REQUIRE(found.size() == 1);
  CHECK_THAT(found[0].unknowns(0), WithinAbs(at.u, 1e-9));
  CHECK_THAT(found[0].unknowns(1), WithinAbs(at.p, 1e-9));
  CHECK_THAT(found[0].parameters(0), WithinAbs(at.q, 1e-9));
}

std::size_t count_turns(const Branch& curve) {
  return static_cast<std::size_t>(
      std::count_if(curve.points.begin(), curve.points.end(),
                    [](const BranchPoint& point) { return is_turn(point.type); }));
}

}  // namespace

TEST_CASE("An isola is born where a curve of folds turns: u^2 + p^2 = q at q = 0") {
  const ScalarProblem problem = sheet_over([](double p) { return p * p; }, [](double p) { return 2 * p; });
  const Branch curve = folds_through(problem, 0, 1, 1, over("q", -1, 2));
  REQUIRE(curve.complete());
  check_isola(curve, PointType::isola_centre, {0, 0, 0});
  CHECK(count_turns(curve) == 1);
}

TEST_CASE("Two branches meet where a curve of folds turns: u^2 - p^2 = q at q = 0") {
  const ScalarProblem problem = sheet_over([](double p) { return -p * p; }, [](double p) { return -2 * p; });
  const Branch curve = folds_through(problem, 0, 1, -1, over("q", -2, 1));
  REQUIRE(curve.complete());
  check_isola(curve, PointType::simple_bifurcation, {0, 0, 0});
  CHECK(count_turns(curve) == 1);
}

TEST_CASE("Birth and merger of one isola are both told: u^2 + p^3 - p = q at 3 p^2 = 1") {
  const double p = 1 / std::sqrt(3.0);
  for (const double begin : {1.2, 0.1, -1.2}) {
    const Branch curve =
        folds_through(cubic_sheet(), 0, begin, begin * begin * begin - begin, over("q", -1, 1));
    REQUIRE(curve.complete());
    check_isola(curve, PointType::isola_centre, {0, p, -2 * p / 3});
    check_isola(curve, PointType::simple_bifurcation, {0, -p, 2 * p / 3});
    CHECK(count_turns(curve) == 2);
  }
}

TEST_CASE("A birth is told on an edge of the range or the window, and at a value asked for") {
  const ScalarProblem problem = sheet_over([](double p) { return p * p; }, [](double p) { return 2 * p; });
  for (const double from : {0.0, -1e-7})
    check_isola(folds_through(problem, 0, 1, 1, over("q", from, 2)), PointType::isola_centre, {0, 0, 0});
  FoldProblem extended(problem, 0);
  for (const double edge : {0.0, -1e-7}) {
    const Branch curve =
        trace_curve(extended, {vector_of({0}), vector_of({1, 1}), 0, {}}, over("q", -1, 2), {edge, 3});
    check_isola(curve, PointType::isola_centre, {0, 0, 0});
    CHECK(curve.complete());
  }
  TraceOptions options = over("q", -1, 2);
  options.stop_at = {0};
  check_isola(folds_through(problem, 0, 1, 1, options), PointType::isola_centre, {0, 0, 0});
  options.stop_after = {{PointType::isola_centre, 1, {}}};
  CHECK(folds_through(problem, 0, 1, 1, options).points.front().type == PointType::isola_centre);
}

TEST_CASE("A cusp is no birth, however near one is") {
  const ScalarProblem cusp =
      level_set([](const Place& z) { return z(0) * z(0) * z(0) - z(2) * z(0) - z(1); },
                [](const Place& z) { return Place(3 * z(0) * z(0) - z(2), -1, -z(0)); });
  const Branch alone = folds_through(cusp, 1, -2, 3, over("q", -1, 4));
  CHECK(of_type(alone, PointType::cusp).size() == 1);
  CHECK(count_turns(alone) == 0);
  // The cusps of u^3 - q u = p^2 - e^2 lie beside where branches meet.
  for (const double e : {0.1, 1e-2, 1e-3}) {
    const ScalarProblem near =
        level_set([=](const Place& z) { return z(0) * z(0) * z(0) - z(2) * z(0) - z(1) * z(1) + e * e; },
                  [](const Place& z) { return Place(3 * z(0) * z(0) - z(2), -2 * z(1), -z(0)); });
    // Folds: q = 3 u^2, p^2 = e^2 - 2 u^3; p = 0 at 2 u^3 = e^2, and cusps at u = 0, p = +-e.
    const double u = std::cbrt(e * e / 2);
    const Branch curve = folds_through(near, -1, std::sqrt(e * e + 2), 3, over("q", -1, 3.5));
    INFO(e << ' ' << curve.explanation);
    CHECK(of_type(curve, PointType::cusp).size() == 2);
    CHECK(count_turns(curve) == 1);
    check_isola(curve, PointType::simple_bifurcation, {u, 0, 3 * u * u});
  }
}

TEST_CASE("Where folds meet the trivial branch of a symmetry nothing is born") {
  // u (p + q u^2 - u^4): folds at q = 2 u^2, p = -u^4.
  const ScalarProblem problem = level_set(
      [](const Place& z) {
        const double s = z(0) * z(0);
        return z(0) * (z(1) + z(2) * s - s * s);
      },
      [](const Place& z) {
        const double s = z(0) * z(0);
        return Place(z(1) + 3 * z(2) * s - 5 * s * s, z(0), z(0) * s);
      });
  const Branch curve = folds_through(problem, 0.7, -std::pow(0.7, 4), 2 * 0.49, over("q", -1, 2));
  INFO(curve.explanation);
  CHECK(of_type(curve, PointType::isola_centre).empty());
  CHECK(of_type(curve, PointType::simple_bifurcation).empty());
}

TEST_CASE("An isola that begins on one of its folds, or beside it, closes there and tells each once") {
  const ScalarProblem circle(
      {"p"}, [](double u, const Vector& p) { return 1 - (p(0) - 3) * (p(0) - 3) - u * u; },
      [](double u, const Vector&) { return -2 * u; },
      {[](double, const Vector& p) { return -2 * (p(0) - 3); }});
  const double angle = GENERATE(0.0, 1e-9, -1e-9, 1e-8, -1e-8, 5e-8, -5e-8, 1e-7, -1e-7, 1e-6, -1e-6);
  const double from = GENERATE(1.0, 2.0);
  CAPTURE(angle, from);
  for (const double max_step : {0.2, 0.1, 0.05, 0.02}) {
    TraceOptions options = over("p", from, 5);
    options.max_step = max_step;
    const Guess guess{vector_of({std::sin(angle)}), vector_of({3 - std::cos(angle)}), {}, {}};
    const Branch isola = from == 2 ? trace(circle, guess, options) : trace_both(circle, guess, options);
    INFO(isola.explanation);
    CHECK(isola.stop == Stop::closed_loop);
    CHECK(isola.first_stop == Branch{}.first_stop);
    CHECK(of_type(isola, PointType::fold).size() == 2);
    CHECK_THAT(isola.points.back().unknowns(0), WithinAbs(isola.points.front().unknowns(0), 1e-10));
  }
}
