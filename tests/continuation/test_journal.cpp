// Work that is interrupted, at whatever moment, and done again: it gives what it would have given.

#include <cmath>

#include "arcslip/continuation/curves/curve.hpp"
#include "arcslip/continuation/path/switching.hpp"
#include "branches.hpp"
#include "catch.hpp"
#include "engine_problems.hpp"
#include "library_cases.hpp"
#include "scalar_problem.hpp"
#include "unfinished_work.hpp"

using namespace arcslip;
using namespace arcslip::continuation;
using namespace arcslip::testing;

namespace {

/// u (p - u^2) = 0 and a corner: at p = 0 a straight branch meets a parabola.
ScalarProblem branching() {
  return {{"p"},
          [](double u, const Vector& p) { return u * (p(0) - u * u); },
          [](double u, const Vector& p) { return p(0) - 3 * u * u; },
          {[](double u, const Vector&) { return u; }}};
}

/// x' = mu + lambda x - x^3, whose folds lie on mu = +-2 (lambda/3)^(3/2).
ScalarProblem cusp_of_two() {
  return {{"mu", "lambda"},
          [](double x, const Vector& p) { return p(0) + p(1) * x - x * x * x; },
          [](double x, const Vector& p) { return p(1) - 3 * x * x; },
          {[](double, const Vector&) { return 1.0; }, [](double x, const Vector&) { return x; }}};
}

}  // namespace

TEST_CASE("A branch interrupted within any step goes on as if it had not been", "[resume]") {
  const Needle needle(1e-4);
  TraceOptions options = over("p", 0.5, 2);
  options.extrema_of = {"amplitude"};
  options.stop_at = {0.7, 1.5};
  check_interrupted(
      [&](const TraceOptions& o) {
        return Branches{trace(needle, {vector_of({-8}), vector_of({0.5})}, o)};
      },
      options);
}

TEST_CASE("A branch traced both ways and one of a corner go on so, too", "[resume]") {
  check_interrupted(
      [](const TraceOptions& o) {
        return Branches{trace_both(FreudensteinRoth(), {vector_of({15, -2}), vector_of({0})}, o)};
      },
      over("x3", -1, 2));
  check_interrupted(
      [](const TraceOptions& o) {
        return Branches{trace(Corner(1, -2), {vector_of({-1}), vector_of({-1})}, o)};
      },
      over("p", -2, 3));
}

TEST_CASE("Connected branches that were interrupted are all found again", "[resume]") {
  check_interrupted(
      [](const TraceOptions& o) {
        return trace_connected(branching(), {vector_of({0}), vector_of({-1})}, o);
      },
      over("p", -1, 1));
}

TEST_CASE("A curve in two parameters goes on where it was left", "[resume]") {
  const ScalarProblem problem = cusp_of_two();
  BranchPoint fold;
  fold.type = PointType::fold;
  fold.unknowns = vector_of({std::sqrt(1.0 / 3)});
  fold.parameters = vector_of({-2 / std::sqrt(27.0), 1});
  const Tracing work = [&](const TraceOptions& o) {
    CurveStart start = curve_through(problem, "mu", fold);
    return Branches{trace_curve(*start.problem, start.point, o, {-0.5, 0.7})};
  };
  check_interrupted(work, over("lambda", -1, 3));
  check_out_of_time(work, over("lambda", -1, 3));
}

TEST_CASE("A curve of Hopf points does not remember the step in which it was interrupted", "[resume]") {
  // Its derivatives are differences, whose steps depend on those before. In the step across the zero-Hopf
  // point the first Lyapunov coefficient has a pole, which is told from a zero by a search of its own.
  constexpr long of_that_step = 600;
  const Instance lorenz("lorenz84", {{"T", 0.04}});
  const auto found = of_type(lorenz.trace(over("F", 3, 1)), PointType::hopf);
  REQUIRE(!found.empty());
  check_interrupted(
      [&](const TraceOptions& o) {
        CurveStart start = curve_through(*lorenz.problem, "F", found.back());
        return Branches{trace_curve(*start.problem, start.point, o, {1, 3})};
      },
      over("T", 1e-4, 0.1), 10000, of_that_step);
}

TEST_CASE("Branches that had no time to be whole are gone on with", "[resume]") {
  check_out_of_time(
      [](const TraceOptions& o) {
        return Branches{trace_both(FreudensteinRoth(), {vector_of({15, -2}), vector_of({0})}, o)};
      },
      over("x3", -1, 2));
  check_out_of_time(
      [](const TraceOptions& o) {
        return trace_connected(branching(), {vector_of({0}), vector_of({-1})}, o);
      },
      over("p", -1, 1));
}
