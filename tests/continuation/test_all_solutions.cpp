// All solutions at a value of the parameters, and what tells that some are missing.

#include <algorithm>
#include <set>

#include "arcslip/continuation/path/all_solutions.hpp"
#include "catch.hpp"
#include "engine_problems.hpp"
#include "scalar_problem.hpp"

using namespace arcslip;
using namespace arcslip::continuation;
using namespace arcslip::testing;

namespace {

/// (u^2 - shift)(u - far) = p, d/du and d/dp.
ScalarProblem pair_and_far(double shift, double far) {
  return ScalarProblem(
      {"p"}, [=](double u, const Vector& p) { return (u * u - shift) * (u - far) - p(0); },
      [=](double u, const Vector&) { return 2 * u * (u - far) + u * u - shift; },
      {[](double, const Vector&) { return -1.0; }});
}

std::vector<double> sorted(const std::vector<Guess>& all) {
  std::vector<double> values;
  for (const Guess& one : all) values.push_back(one.unknowns(0));
  std::sort(values.begin(), values.end());
  return values;
}

}  // namespace

TEST_CASE("A branch that comes back to the parameter finds what deflation is not asked for") {
  // One guess, no box: on the branch through the folds of mu + x - x^3 = 0 lie all three.
  SolveAllOptions options;
  const SolutionSearch search = search_solutions(Cusp(), {{vector_of({1}), vector_of({0})}}, options);
  CHECK(search.finished);
  CHECK(search.branches == 1);  // the others are on it
  const std::vector<double> values = sorted(search.solutions);
  REQUIRE(values.size() == 3);
  for (int i = 0; i < 3; ++i) CHECK(std::abs(values[static_cast<std::size_t>(i)] - (i - 1)) < 1e-12);
}

TEST_CASE("Solutions that coincide are one, those 1e-6 apart two") {
  const Vector p = vector_of({0});
  SolveAllOptions options;
  options.lower = vector_of({-3});
  options.upper = vector_of({3});
  const std::vector<double> fold = sorted(solve_all(pair_and_far(0, 2), {{vector_of({1}), p}}, options));
  REQUIRE(fold.size() == 2);
  CHECK(std::abs(fold[0]) < 1e-7);  // the root of rounding
  const std::vector<double> close =
      sorted(solve_all(pair_and_far(2.5e-13, 2), {{vector_of({1}), p}}, options));
  REQUIRE(close.size() == 3);
  CHECK(std::abs(close[1] - close[0] - 1e-6) < 1e-9);
  const ScalarProblem triple(
      {"p"}, [](double u, const Vector& q) { return u * u * u - q(0); },
      [](double u, const Vector&) { return 3 * u * u; }, {[](double, const Vector&) { return -1.0; }});
  CHECK(solve_all(triple, {{vector_of({1}), p}}, options).size() == 1);
}

TEST_CASE("Independent starts tell how many solutions one of them alone has found") {
  SolveAllOptions options;
  options.lower = vector_of({-3});
  options.upper = vector_of({3});
  options.branches = false;
  const SolutionSearch search =
      search_solutions(pair_and_far(1, 2), {{vector_of({3}), vector_of({0})}}, options);
  CHECK(search.solutions.size() == 3);
  CHECK(search.runs > 50);
  CHECK(search.singles == 0);
}

TEST_CASE("The degree contradicts a list from which a solution is missing") {
  const Vector p = vector_of({0});
  const Vector lower = vector_of({-3});
  const Vector upper = vector_of({3});
  const ScalarProblem problem = pair_and_far(1, 2);
  std::vector<Guess> all = solve_all(problem, {{vector_of({3}), p}});
  REQUIRE(all.size() == 3);
  const auto whole = check_degree(problem, all, lower, upper);
  REQUIRE(whole);
  CHECK(whole->expected == 1);
  CHECK(whole->found == 1);
  all.pop_back();
  const auto lacking = check_degree(problem, all, lower, upper);
  REQUIRE(lacking);
  CHECK(lacking->found != lacking->expected);
  CHECK_FALSE(check_degree(problem, all, vector_of({0}), upper));  // it points inward at one end alone
}

TEST_CASE("What ends a search is told") {
  SolveAllOptions options;
  options.lower = vector_of({-3});
  options.upper = vector_of({3});
  int asked = 0;
  options.go_on = [&] { return ++asked < 5; };
  CHECK_FALSE(search_solutions(Cusp(), {{vector_of({1}), vector_of({0})}}, options).finished);
}
