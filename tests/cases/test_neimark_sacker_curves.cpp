// Curves in two parameters of Neimark-Sacker points, of maps and of cycles, where they meet those of folds,
// of period doublings and of another pair, all known in closed form; and where the pair of such curves, or
// of those of Hopf points, meets with two eigenvectors: they go on, as they do not where it meets with one.

#include <fmt/format.h>

#include "arcslip/continuation/cycles/doubling_problem.hpp"
#include "arcslip/continuation/points/fold_problem.hpp"
#include "cycle_cases.hpp"

namespace {

using namespace arcslip;
using namespace arcslip::testing;
using continuation::DoublingProblem;
using continuation::FoldProblem;

// k = +-sqrt(mu) has a fold at mu = 0; a pair's modulus is 1 where a = 0, another's where d = 0, and a
// multiplier -1 where b = 0.
const std::string pair_numbers = R"case(
[model.parameters]
mu = 0.04
q = 0.1
[model.definitions]
a = "q - 0.5*k"
b = "mu + q - 0.12"
d = "mu + 0.3*q - 0.05"
)case";

const std::string map_of_pairs = "[model]\nkind = \"map\"\n" + pair_numbers + R"case(
r = "1 + a - y^2 - z^2"
s = "1 + d - u^2 - v^2"
[model.equations]
k = "k + mu - k^2"
y = "r*(0.6*y - 0.8*z)"
z = "r*(0.8*y + 0.6*z)"
w = "-(1 + b)*w + w^3"
u = "s*(0.28*u - 0.96*v)"
v = "s*(0.96*u + 0.28*v)"
[model.start]
k = 0.2
)case";

// Round the circle x = cos t, y = sin t the two of (w1, w2) turn by half a round, and grow as b and -1.
const std::string field_of_pairs = pair_numbers + R"case(
[model.equations]
x = "(1 - x^2 - y^2)*x - y"
y = "x + (1 - x^2 - y^2)*y"
k = "mu - k^2"
z1 = "(a - z1^2 - z2^2)*z1 - 0.31*z2"
z2 = "0.31*z1 + (a - z1^2 - z2^2)*z2"
w1 = "-w2/2 + (b - 1)/2*w1 + (b + 1)/2*(x*w1 + y*w2) - w1^3"
w2 = "w1/2 + (b - 1)/2*w2 + (b + 1)/2*(y*w1 - x*w2) - w2^3"
v1 = "(d - v1^2 - v2^2)*v1 - 0.43*v2"
v2 = "0.43*v1 + (d - v1^2 - v2^2)*v2"
[model.start]
x = 1
k = 0.2
[cycles]
settle = 100
)case";

std::string along(const std::string& curve) {
  return "[branch]\ncurve = \"" + curve +
         "\"\nswitching = true\nparameters = [\"mu\", \"q\"]\nwindow = [0.1, -0.1]\nfrom = -0.15\nto = "
         "0.15\n";
}

// The meetings: of both pairs, where mu = 4 q^2 and mu + 0.3 q = 0.05, k > 0; of the first and -1, where mu =
// 4 q^2 and mu + q = 0.12; of the second and -1, of either k.
const double q_of_both = (-0.3 + std::sqrt(0.89)) / 8;
const double q_of_first = (-1 + std::sqrt(2.92)) / 8;

template <class Special>
bool is_of(const TracedBranch& curve) {
  return dynamic_cast<const Special*>(curve.curve.get()) != nullptr;
}

/// The points of this type on the curve number i, by their place.
void check_meetings(const TracedBranch& curve, PointType type, const std::vector<double>& expected) {
  INFO(to_string(type));
  check_values(values_at(curve, type, "q"), expected, 1e-9);
}

void check_passes(const TracedBranch& curve) {
  CHECK(curve.branch.complete());
  for (const PointType type : {PointType::resonance_1_1, PointType::resonance_1_2, PointType::bogdanov_takens,
                               PointType::fold, PointType::corner_fold, PointType::peak, PointType::trough})
    CHECK(count(curve, type) == 0);
}

}  // namespace

TEST_CASE("Curves of Neimark-Sacker points tell what they meet, and are followed from there", "[cycles]") {
  const auto check = [](const std::string& system, const std::string& fold, const std::string& step) {
    for (const std::string& curve : {std::string("neimark_sacker"), std::string("period_doubling"), fold}) {
      INFO(curve << ' ' << step);
      const auto all = traced_of(system + along(curve), {"continuation.max_step=" + step});
      int of_first = 0;
      int of_second = 0;
      int doublings = 0;
      int folds = 0;
      for (const TracedBranch& one : all) {
        CHECK(one.branch.complete());
        const BranchPoint start = points(one, PointType::start).front();
        const double mu = value(one, start, "mu");
        const double q = value(one, start, "q");
        if (one.curve->base().observables().front().name == "T" && value(one, start, "T") > 7)
          continue;  // of cycles that have doubled
        if (is_of<DoublingProblem>(one)) {
          ++doublings;
          check_meetings(one, PointType::fold_flip, {0.12});
          CHECK(values_at(one, PointType::flip_neimark_sacker, "q").size() == 3);
        } else if (is_of<FoldProblem>(one)) {
          ++folds;
          check_meetings(one, PointType::fold_neimark_sacker, {0});
          check_meetings(one, PointType::fold_flip, {0.12});
        } else if (std::abs(mu - 4 * q * q) < 1e-9) {
          ++of_first;
          check_meetings(one, PointType::fold_neimark_sacker, {0});
          check_meetings(one, PointType::double_neimark_sacker, {q_of_both});
          check_meetings(one, PointType::flip_neimark_sacker, {q_of_first});
        } else {
          ++of_second;
          check_meetings(one, PointType::flip_neimark_sacker, {0.1});
          CHECK(values_at(one, PointType::fold_neimark_sacker, "q").empty());
        }
      }
      CHECK(of_first == 1);
      CHECK(of_second == 2);
      CHECK(doublings == 1);
      CHECK(folds == 1);
    }
  };
  for (const std::string step : {"0.02", "0.1", "0.3"}) check(map_of_pairs, "fold", step);
  check(field_of_pairs, "cycle_fold", "0.1");
}

TEST_CASE("Pairs are told once behind a period doubling in the same step", "[cycles]") {
  for (const std::string& system : {map_of_pairs, field_of_pairs}) {
    for (const std::string& range :
         {std::string("from = -0.2\nto = 0.3\n"), std::string("from = 0.3\nto = -0.2\n")}) {
      INFO(range);
      const auto all =
          traced_of(system + "[branch]\nparameter = \"q\"\n" + range, {"continuation.max_step=1"});
      REQUIRE(all.size() == 1);
      auto pairs = values_at(all[0], PointType::neimark_sacker, "q");
      std::sort(pairs.begin(), pairs.end());
      check_values(pairs, {1 / 30.0, 0.1}, 1e-9);
      check_values(values_at(all[0], PointType::period_doubling, "q"), {0.08}, 1e-9);
    }
  }
}

TEST_CASE("Special points that fall on one place are told beside each other, in long steps and short ones",
          "[cycles]") {
  // A real eigenvalue b, a period doubling w and two pairs, each of which passes at its own q, one way or the
  // other.
  const auto told = [](const std::string& b, const std::string& w, const std::string& first,
                       const std::string& second, const std::string& step) {
    const auto all =
        traced_of("[model]\nkind = \"map\"\n[model.parameters]\nq = 0\n[model.definitions]\nr = \"1 + " +
                      first + " - y^2 - z^2\"\ns = \"1 + " + second + R"case( - u^2 - v^2"
[model.equations]
b = "(1 + )case" + b + R"case()*b - b^3"
w = "-(1 + )case" + w +
                      R"case()*w + w^3"
y = "r*(0.6*y - 0.8*z)"
z = "r*(0.8*y + 0.6*z)"
u = "s*(-0.28*u - 0.96*v)"
v = "s*(0.96*u - 0.28*v)"
[branch]
parameter = "q"
from = 1
to = 0
)case",
                  {"continuation.max_step=" + step});
    std::vector<std::string> points;
    for (const BranchPoint& point : all[0].branch.points) {
      if (point.type == PointType::branch_point || point.type == PointType::period_doubling ||
          point.type == PointType::neimark_sacker)
        points.push_back(fmt::format("{} {:.3g}", to_string(point.type), value(all[0], point, "q")));
    }
    std::sort(points.begin(), points.end());
    return points;
  };
  using Names = std::vector<std::string>;
  for (const std::string step : {"0.02", "0.1", "0.3", "1"}) {
    INFO(step);
    CHECK(told("0.3*(q - 0.5)", "2*(q - 0.8)", "2*(q - 0.5)", "-0.3*(q - 0.8)", step) ==
          Names{"branch_point 0.5", "neimark_sacker 0.5", "neimark_sacker 0.8", "period_doubling 0.8"});
    CHECK(told("-0.3*(q - 0.2)", "0.3*(q - 2)", "2*(q - 0.5)", "-1*(q - 0.2)", step) ==
          Names{"branch_point 0.2", "neimark_sacker 0.2", "neimark_sacker 0.5"});
    CHECK(told("-1*(q - 0.8)", "0.3*(q - 2)", "0.3*(q - 0.8)", "-1*(q - 0.7)", step) ==
          Names{"branch_point 0.8", "neimark_sacker 0.7", "neimark_sacker 0.8"});
    // One pair comes to the axis where another has just left it.
    CHECK(told("0.3*(q - 0.5)", "-0.3*(q - 0.4)", "-1*(q - 0.2)", "2*(q - 0.1)", step) ==
          Names{"branch_point 0.5", "neimark_sacker 0.1", "neimark_sacker 0.2", "period_doubling 0.4"});
  }
}

TEST_CASE("A curve of tori of a map goes on where the pair meets with two eigenvectors", "[cycles]") {
  const auto turning = [](const std::string& to) {  // z -> (1 + mu - 0.1 w) e^(jw) z - ...
    const std::string text = R"case(
[model]
kind = "map"
[model.parameters]
mu = -0.1
w = 0.5
[model.equations]
p = "(1 + mu - 0.1*w)*(cos(w)*p - sin(w)*q) - p*(p^2 + q^2)"
q = "(1 + mu - 0.1*w)*(cos(w)*q + sin(w)*p) - q*(p^2 + q^2)"
[branch]
curve = "neimark_sacker"
parameters = ["mu", "w"]
window = [-0.5, 1]
from = 0.1
)case";
    const auto all = traced_of(text + "to = " + to + "\n");
    REQUIRE(all.size() == 1);
    check_passes(all[0]);
    for (const BranchPoint& point : all[0].branch.points)
      CHECK_THAT(value(all[0], point, "mu"), WithinAbs(0.1 * value(all[0], point, "w"), 1e-9));
    return all_values_at(all, PointType::resonance_1_3, "w");
  };
  check_values(turning("7"), {two_pi / 3, 2 * two_pi / 3}, 1e-8);
  check_values(turning("3.14159265358979312"), {two_pi / 3}, 1e-8);
}

TEST_CASE("A curve of tori of a forced oscillation goes on where the pair meets with two eigenvectors",
          "[cycles]") {
  const auto all = traced_of(R"case(
[model]
kind = "forced"
period = "2*pi"
[model.parameters]
mu = 0.1
w = 0.3
[model.equations]
x = "-x + cos(t)"
p = "(mu - 0.1*(w - 1))*p - w*q - p*(p^2 + q^2)"
q = "(mu - 0.1*(w - 1))*q + w*p - q*(p^2 + q^2)"
[cycles]
settle = 100
[branch]
curve = "neimark_sacker"
parameters = ["mu", "w"]
window = [-0.5, 0.5]
from = 0.1
to = 1.8
)case");
  REQUIRE(all.size() == 1);
  check_passes(all[0]);
  check_values(all_values_at(all, PointType::resonance_1_3, "w"), {1.0 / 3, 2.0 / 3, 4.0 / 3, 5.0 / 3}, 1e-8);
  check_values(all_values_at(all, PointType::resonance_1_3, "mu"), {-2.0 / 30, -1.0 / 30, 1.0 / 30, 2.0 / 30},
               1e-8);
}

TEST_CASE("A curve of tori of odd oscillations goes on where half a period turns by a quarter", "[cycles]") {
  const auto all = traced_of(R"case(
[model]
kind = "forced"
period = "2*pi/W"
[model.parameters]
W = 0.75
F = 1
mu = 0.4
[model.equations]
x = "v"
v = "mu*(1 - x^2)*v - x + F*cos(W*t)"
[cycles]
settle = 300
[branch]
curve = "neimark_sacker"
parameters = ["W", "F"]
window = [0.4, 1]
from = 0.4
to = 1.05
)case");
  REQUIRE(all.size() == 1);
  check_passes(all[0]);
  // Where half a period's map with its sign turned, of determinant 1, has the traces -1 and 1, by integration
  // in time; at F = 0.8198421, between, it is 0.
  check_values(all_values_at(all, PointType::resonance_1_3, "W"), {0.59070927, 0.73304672}, 1e-7);
  check_values(all_values_at(all, PointType::resonance_1_3, "F"), {0.67825161, 0.92533674}, 1e-7);
}

TEST_CASE("A curve of Hopf points goes on where the pair vanishes with two eigenvectors", "[hopf]") {
  const std::string step = GENERATE("0.5", "0.1", "0.07", "0.04", "0.02");
  INFO(step);
  const auto all = traced_of(R"case(
[model.parameters]
mu = -0.3
w = 0.5
[model.equations]
x = "(mu - 0.1*w)*x - y - x*(x^2 + y^2)"
y = "(mu - 0.1*w)*y + x - y*(x^2 + y^2)"
p = "(mu + 0.1*w)*p - (1 + w)*q - p*(p^2 + q^2)"
q = "(mu + 0.1*w)*q + (1 + w)*p - q*(p^2 + q^2)"
[branch]
curve = "hopf"
parameters = ["mu", "w"]
window = [-0.5, 1]
from = -1.5
to = 1
)case",
                             {"continuation.max_step=" + step});
  REQUIRE(all.size() == 2);
  for (const TracedBranch& one : all) {
    check_passes(one);
    CHECK(count(one, PointType::hopf_hopf) == 1);
    for (const BranchPoint& point : one.branch.points)
      CHECK_THAT(std::abs(value(one, point, "mu")), WithinAbs(std::abs(0.1 * value(one, point, "w")), 1e-9));
  }
}

TEST_CASE("Curves of period doublings that do not touch each other cross", "[cycles]") {
  const auto all = traced_of(R"case(
[model]
kind = "map"
[model.parameters]
a = 0
b = 0.5
[model.equations]
x = "-(1 + a - b)*x + x^3"
y = "-(1 + a + b)*y + y^3"
[branch]
curve = "period_doubling"
parameters = ["a", "b"]
window = [-0.9, 0.9]
from = -0.8
to = 0.8
)case");
  REQUIRE(all.size() == 2);
  for (const TracedBranch& one : all) {
    CHECK(one.branch.complete());
    check_values(values_at(one, PointType::resonance_1_2, "b"), {0}, 1e-9);
    for (const BranchPoint& point : one.branch.points)
      CHECK_THAT(std::abs(value(one, point, "a")), WithinAbs(std::abs(value(one, point, "b")), 1e-9));
  }
}

TEST_CASE("No curve that leaves a special point has points outside of its window", "[hopf]") {
  // On m1 = 0 the origin is a branch point whatever m2 is, which the equations of folds put anywhere.
  const auto all = traced_of(R"case(
[model.parameters]
m1 = -0.5
m2 = -0.5
[model.equations]
x = "y"
y = "m1*x + m2*y - x^3 - x^2*y"
[branch]
curve = "hopf"
parameters = ["m2", "m1"]
window = [-0.5, 2]
from = -1
to = 2
switching = true
)case");
  REQUIRE(!all.empty());
  CHECK(count(all[0], PointType::bogdanov_takens) == 1);
  for (const TracedBranch& one : all) {
    for (const BranchPoint& point : one.branch.points) {
      CHECK(value(one, point, "m2") > -0.5 - 1e-6);
      CHECK(value(one, point, "m2") < 2 + 1e-6);
    }
  }
}
