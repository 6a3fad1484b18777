// Whether the solutions that a case finds are all.

#include <Eigen/LU>
#include <set>

#include "case_runs.hpp"

using namespace arcslip;
using namespace arcslip::testing;

namespace {

/// The first equation of the aircraft's at a roll rate for which the four others, linear in what is left, are
/// solved, times the square of their determinant: a polynomial.
double remaining(double roll, double elevator) {
  Eigen::Matrix4d linear;  // of pitch, yaw, attack, sideslip
  linear << -0.987, 0.949 * roll, -22.95, 0.173 * roll, -0.716 * roll, -0.235, -1.578 * roll, 5.67, 1, 0, -1,
      -roll, 0, -1, roll, -0.196;
  const Eigen::Vector4d right(28.37 * elevator, -0.002 * roll, 0.168 * elevator, 0);
  const Eigen::PartialPivLU<Eigen::Matrix4d> factors(linear);
  const Eigen::Vector4d rest = factors.solve(right);
  const double pitch = rest(0), yaw = rest(1), attack = rest(2), sideslip = rest(3);
  const double first = -3.933 * roll + 0.107 * pitch + 0.126 * yaw - 9.99 * sideslip - 0.727 * pitch * yaw +
                       8.39 * yaw * attack - 684.4 * attack * sideslip;
  return first * std::pow(factors.determinant(), 2);
}

/// Changes of sign over all roll rates, tan of an angle.
int rolls(double elevator) {
  constexpr int count = 100001;
  int changes = 0;
  double last = 0;
  for (int i = 1; i < count; ++i) {
    const double value = remaining(std::tan(pi * (i / static_cast<double>(count) - 0.5)), elevator);
    if (last * value < 0) ++changes;
    last = value;
  }
  return changes;
}

std::set<long> user_rolls(const Run& run) {
  std::set<long> found;
  for (const TracedBranch& one : run.traced) {
    for (const BranchPoint& point : one.branch.points) {
      if (point.parameters(0) == one.request->start) found.insert(std::lround(1e8 * point.unknowns(0)));
    }
  }
  return found;
}

}  // namespace

TEST_CASE("All steady rolls of the aircraft are found and proven to be all", "[cases]") {
  const std::string elevator = GENERATE("-0.008", "0.0", "-0.05");
  const Run run("aircraft", {"branch.start=" + elevator});
  REQUIRE(!run.traced.empty());
  const problems::SolutionCount& told = *run.traced.front().solutions;
  INFO(told.reason);
  CHECK(told.complete == true);
  CHECK(told.reason.find("alone") == std::string::npos);  // deflation and branches found them all
  const double value = std::stod(elevator);
  const auto expected = value == 0 ? 9 : static_cast<std::size_t>(rolls(value));  // at 0 one is roll = 0
  CHECK(told.count == expected);
  CHECK(user_rolls(run).size() == expected);
}

TEST_CASE("The aircraft has its published limit points", "[cases]") {
  // Melhem & Rheinboldt 1982, over the aileron with the rudder neutral: elevator, aileron, and the unknowns
  const std::vector<std::vector<double>> published{
      {-0.05, -0.50481, 2.9648, 0.82556, 0.07366, 0.04131, 0.26735},
      {-0.008, -0.20497, 2.8174, -0.17629, 0.08993, 0.02643, -0.07148},
      {-0.008, 0.00621, 3.7579, -0.65542, 0.38658, 0.09252, -0.19867},
      {-0.008, -0.37766, 4.1638, 0.08913, 0.09481, 0.02289, 0.01623}};
  for (const std::vector<double>& one : published) {
    const Run run("aircraft",
                  {fmt::format("model.parameters.elevator={}", one[0]), "branch.parameter=aileron",
                   "branch.from=-0.6", "branch.to=0.6", "branch.start=0.0"});
    bool is_there = false;
    for (const TracedBranch& traced : run.traced) {
      for (const BranchPoint& fold : points(traced, PointType::fold)) {
        const Vector unknowns = Eigen::Map<const Vector>(one.data() + 2, 5);
        is_there = is_there || (std::abs(fold.parameters(1) - one[1]) < 1e-5 &&
                                (fold.unknowns - unknowns).lpNorm<Eigen::Infinity>() < 1e-4);
      }
    }
    CHECK(is_there);
  }
}

TEST_CASE("What lies outside of the box is found by branches, and not said to be all", "[cases]") {
  const Run run("aircraft", {"branch.box=[-1, 1]"});
  const problems::SolutionCount& told = *run.traced.front().solutions;
  CHECK(told.complete == true);
  CHECK(told.count == 9);
  CHECK(told.reason.find("outside the box are 8 more") != std::string::npos);
}

TEST_CASE("Without formulas a list is not said to be complete", "[cases]") {
  const Run run("freudenstein_roth", {"branch.start=-0.5", "branch.all_solutions=true"});
  const problems::SolutionCount& told = *run.traced.front().solutions;
  CHECK_FALSE(told.complete);
  CHECK(told.count == 3);
  CHECK(told.reason.find("independent starts") != std::string::npos);
}

TEST_CASE("A box that does not fit is refused", "[cases]") {
  CHECK_THROWS_WITH(Run("aircraft", {"branch.box=[1, -1]"}), ContainsSubstring("branch.box"));
  CHECK_THROWS_WITH(Run("aircraft", {"branch.box=[0, 1, 0, 1]"}),
                    ContainsSubstring("each of the 5 unknowns"));
}
