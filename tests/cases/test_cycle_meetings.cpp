// Cycles where several things meet, and what is refused.

#include "cycle_cases.hpp"

using namespace arcslip;
using namespace arcslip::testing;

TEST_CASE("A branch of cycles between two Hopf points is traced once", "[cycles]") {
  const auto all = traced_of(circles(
      "0.25 - mu^2 - s", "1 + mu", "[branch]\nparameter = \"mu\"\nfrom = -0.9\nto = 1\nswitching = true\n"));
  CHECK(all_values_at(all, PointType::hopf, "mu").size() == 2);
  const auto found = cycles_of(all);
  REQUIRE(found.size() == 1);
  CHECK(found[0].branch.stop == Stop::left_regime);
  CHECK_THAT(found[0].branch.points.back().parameters(0), WithinAbs(0.5, 1e-8));
  for (const BranchPoint& point : found[0].branch.points) {
    const double mu = point.parameters(0);
    CHECK_THAT(value(found[0], point, "norm"), WithinAbs(std::sqrt(std::max(0.0, 0.25 - mu * mu)), 1e-7));
  }
}

TEST_CASE("Cycles that leave no equilibrium are a closed branch", "[cycles]") {
  const auto all = traced_of(circles("0.25 - mu^2 - (s - 1)^2", "1",
                                     "[model.start]\nx = 1.3\n[cycles]\nsettle = 60\n[branch]\n"
                                     "parameter = \"mu\"\nfrom = -1\nto = 1\nstart = 0\n"));
  REQUIRE(all.size() == 1);
  CHECK(all[0].branch.stop == Stop::closed_loop);
  check_values(all_values_at(all, PointType::fold, "mu"), {-0.5, 0.5}, 1e-9);
}

TEST_CASE("A closed branch on which meshes and phases change ends where it began", "[cycles]") {
  // They all but rest at a place of the circle that moves along with it.
  const auto all = traced_of(circles(
      "0.25 - mu^2 - (s - 1)^2", "1.05 + (x*cos(4*mu) + y*sin(4*mu))/sqrt(s)",
      "[model.start]\nx = 1.3\n[cycles]\nsettle = 200\n[branch]\nparameter = \"mu\"\nfrom = -1\nto = 1\n"
      "start = 0\n"));
  REQUIRE(all.size() == 1);
  CHECK(all[0].branch.stop == Stop::closed_loop);
  check_values(all_values_at(all, PointType::fold, "mu"), {-0.5, 0.5}, 1e-8);
  CHECK_THAT(value(all[0], all[0].branch.points.back(), "mu"), WithinAbs(0, 1e-8));
}

TEST_CASE("A closed branch that leaves a branch point comes back to it, whatever its meshes are",
          "[cycles]") {
  // Two of FitzHugh's and Nagumo's nerves
  const auto all = traced_of(R"case(
[model.parameters]
I = 0
[model.equations]
v1 = "v1 - v1^3/3 - w1 + I - 0.1*(v2 - v1)"
w1 = "0.2*(v1 + 0.7 - 0.8*w1)"
v2 = "v2 - v2^3/3 - w2 + I - 0.1*(v1 - v2)"
w2 = "0.2*(v2 + 0.7 - 0.8*w2)"
[model.start]
v1 = -1.2
v2 = -1.2
w1 = -0.6
w2 = -0.6
[cycles]
doublings = 0
[branch]
parameter = "I"
from = 0.3
to = 1.45
switching = true
)case");
  const auto found = cycles_of(all);
  REQUIRE(found.size() == 2);
  CHECK(found[1].branch.stop == Stop::closed_loop);
  const BranchPoint& end = found[1].branch.points.back();
  CHECK_THAT(value(found[1], end, "I"), WithinAbs(0.373543006, 1e-8));
  CHECK_THAT(value(found[1], end, "T"), WithinAbs(29.1843566, 1e-5));
  CHECK(values_at(found[1], PointType::branch_point, "I").size() == 1);
  CHECK(values_at(found[1], PointType::period_doubling, "I").size() == 8);
}

TEST_CASE("Doubled cycles go on while their halves differ, however they have changed", "[cycles]") {
  // The difference between both halves turns to what is all but orthogonal to the first one of the branch.
  const auto all = traced_of(R"case(
[model]
kind = "forced"
period = "2*pi/w"
[model.parameters]
w = 1
[model.equations]
x = "0.4 - 2.2*x + x^2*y + 0.05*cos(w*t)"
y = "1.2*x - x^2*y"
[model.start]
x = 0.4
y = 3
[cycles]
doublings = 1
[branch]
parameter = "w"
from = 0.3
to = 1.2
switching = true
)case");
  REQUIRE(all.size() == 2);
  check_values(values_at(all[0], PointType::period_doubling, "w"), {0.398247435, 0.955971555}, 1e-8);
  check_values(values_at(all[1], PointType::period_doubling, "w"), {0.713101407, 0.871914228}, 1e-8);
  check_values(values_at(all[1], PointType::neimark_sacker, "w"), {0.951797946}, 1e-8);
  CHECK(all[1].branch.stop == Stop::left_regime);
  CHECK_THAT(value(all[1], all[1].branch.points.back(), "w"), WithinAbs(0.955971555, 1e-6));
}

TEST_CASE("Cycles that a motion settles on end where they come to be two rounds", "[cycles]") {
  // A mesh whose halves are not alike breaks what is a pitchfork of both rounds.
  for (const auto& [tolerance, margin] : {std::pair("1e-6", 2e-5), std::pair("1e-8", 1e-6)}) {
    CAPTURE(tolerance);
    const auto all = Run("roessler_cascade",
                         {"branch.from=3.2", "branch.to=2.5", fmt::format("cycles.tolerance={}", tolerance)})
                         .traced;
    REQUIRE(all.size() == 1);
    CHECK(all[0].branch.stop == Stop::left_regime);
    CHECK_THAT(all[0].branch.explanation, ContainsSubstring("two rounds of one of half the period"));
    CHECK_THAT(value(all[0], all[0].branch.points.back(), "c"), WithinAbs(2.83244503, margin));
  }
}

TEST_CASE("Where more branches of cycles leave than are followed, the last one says so", "[cycles]") {
  for (const std::size_t most : {1, 2, 3}) {
    CAPTURE(most);
    const auto all = Run("roessler_cascade", {fmt::format("cycles.max_branches={}", most)}).traced;
    REQUIRE(all.size() == most);
    for (std::size_t i = 0; i + 1 < most; ++i) CHECK(all[i].branch.warning.empty());
    const std::string& told = all.back().branch.warning;
    if (most == 3) CHECK(told.empty());  // those are all
    if (most == 1)
      CHECK_THAT(told, ContainsSubstring("max_branches = 1 were followed; what leaves at c = 2.83244"));
    if (most == 2)
      CHECK_THAT(told, ContainsSubstring("max_branches = 2 were followed; what leaves at c = 3.83735"));
  }
}

TEST_CASE("Cycles leave a Hopf point that lies a millionth from a fold", "[cycles]") {
  const auto all = traced_of(R"case(
[model.parameters]
mu = 1
[model.equations]
x = "(z - 0.001 - x^2 - y^2)*x - y"
y = "x + (z - 0.001 - x^2 - y^2)*y"
z = "mu - z^2"
[model.start]
z = "-sqrt(mu)"
[branch]
parameter = "mu"
from = 1
to = -1
switching = true
)case");
  check_values(all_values_at(all, PointType::fold, "mu"), {0}, 1e-12);
  check_values(all_values_at(all, PointType::hopf, "mu"), {1e-6}, 1e-12);
  const auto found = cycles_of(all);
  REQUIRE(found.size() == 1);
  for (const BranchPoint& point : found[0].branch.points) {
    const double z = std::sqrt(point.parameters(0));
    CHECK_THAT(value(found[0], point, "norm"), WithinAbs(std::hypot(z, std::sqrt(z - 0.001)), 1e-7));
  }
}

TEST_CASE("Two pairs of eigenvalues cross at one point, and cycles of both leave it", "[cycles]") {
  const auto all = traced_of(R"case(
[model.parameters]
mu = -0.5
[model.definitions]
s = "x^2 + y^2"
q = "z^2 + w^2"
[model.equations]
x = "(mu - s - 2*q)*x - y"
y = "x + (mu - s - 2*q)*y"
z = "(mu - q - 2*s)*z - sqrt(2)*w"
w = "sqrt(2)*z + (mu - q - 2*s)*w"
[branch]
parameter = "mu"
from = -0.5
to = 1
switching = true
)case");
  const auto found = cycles_of(all);
  REQUIRE(found.size() == 2);
  std::vector<double> periods;
  for (const TracedBranch& one : found) {
    CHECK(one.branch.stop == Stop::reached_end);
    periods.push_back(value(one, one.branch.points.back(), "T"));
    for (const BranchPoint& point : one.branch.points)
      CHECK_THAT(value(one, point, "norm"), WithinAbs(std::sqrt(point.parameters(0)), 1e-7));
  }
  std::sort(periods.begin(), periods.end());
  check_values(periods, {2 * pi / std::sqrt(2.0), 2 * pi}, 1e-9);
}

TEST_CASE("A period doubles a millionth from where cycles turn back", "[cycles]") {
  // Circles with s = 1 +- sqrt(mu), beside a direction that turns by half a round with each: its multiplier
  // is -e^(2 pi (c + s - 1)).
  const auto all = traced_of(R"case(
[model.parameters]
mu = 0.2
c = 0.001
[model.definitions]
s = "x^2 + y^2"
C = "x/sqrt(s)"
S = "y/sqrt(s)"
a = "c + s - 1"
g = "mu - (s - 1)^2"
q = "z^2 + w^2"
[model.equations]
x = "g*x - y"
y = "x + g*y"
z = "(a - 1)/2*z + (a + 1)/2*(C*z + S*w) - w/2 - z*q"
w = "(a - 1)/2*w + (a + 1)/2*(S*z - C*w) + z/2 - w*q"
[model.start]
x = 1.2
[cycles]
settle = 300
doublings = 1
[branch]
parameter = "mu"
from = 0.2
to = -1
switching = true
)case");
  REQUIRE(all.size() == 2);
  check_values(values_at(all[0], PointType::fold, "mu"), {0}, 1e-10);
  check_values(values_at(all[0], PointType::period_doubling, "mu"), {1e-6}, 1e-11);
  CHECK_THAT(value(all[0], all[0].branch.points.front(), "T"), WithinAbs(2 * pi, 1e-8));
  for (const BranchPoint& point : all[1].branch.points) {
    CHECK_THAT(value(all[1], point, "T"), WithinAbs(4 * pi, 1e-6));
  }
}

TEST_CASE("What asks for cycles where there are none is refused on one line", "[cycles]") {
  const auto refusal = [](const std::string& equations, const std::string& start) {
    const auto all =
        traced_of("[model.parameters]\nmu = 1\n[model.equations]\n" + equations + "[model.start]\n" + start +
                  "[cycles]\nsettle = 60\n[branch]\n" + "parameter = \"mu\"\nfrom = 1\nto = 2\n");
    REQUIRE(all.size() == 1);
    CHECK(all[0].branch.stop == Stop::no_start);
    CHECK(all[0].branch.explanation.find('\n') == std::string::npos);
    return all[0].branch.explanation;
  };
  CHECK_THAT(refusal("x = \"y\"\ny = \"-x - mu*y\"\n", "x = 1\n"), ContainsSubstring("has come to rest"));
  CHECK_THAT(refusal("x = \"mu\"\ny = \"-y\"\n", "x = 1\n"), ContainsSubstring("does not come back"));
  CHECK_THAT(refusal("x = \"mu*x^2\"\ny = \"-y\"\n", "x = 1\n"), ContainsSubstring("cannot be followed"));
  CHECK_THAT(refusal("x = \"sqrt(-mu - x^2)\"\ny = \"-y\"\n", "x = 1\n"),
             ContainsSubstring("cannot be followed"));
}
