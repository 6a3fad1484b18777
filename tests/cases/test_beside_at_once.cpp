// Special points close to others, at which multipliers or eigenvalues pass at once, in closed form.

#include <fmt/format.h>

#include "cycle_cases.hpp"

namespace {

using namespace arcslip;
using namespace arcslip::testing;

/// One multiplier is -1 at p = 0, two are at p = way.
std::string doublings(double way) {
  return fmt::format(R"case(
[model]
kind = "map"
[model.parameters]
p = -0.5
d = {:.17g}
[model.equations]
u = "-(1 + p)*u + u^3"
a = "-(1 + p - d)*a + a*(a^2 + 2*b^2)"
b = "-(1 + p - d)*b + b*(b^2 + 2*a^2)"
[branch]
parameter = "p"
from = -0.5
to = 0.7
)case",
                     way);
}

/// Three logistic maps, each of which feels the others: those of all alike double at r = 3, the two ways in
/// which they differ at r = 2 + 1/(1 - 3 c).
std::string coupled_maps(double coupling) {
  return fmt::format(R"case(
[model]
kind = "map"
[model.parameters]
r = 1.2
c = {:.17g}
[model.equations]
x = "(1 - 2*c)*r*x*(1 - x) + c*r*y*(1 - y) + c*r*z*(1 - z)"
y = "(1 - 2*c)*r*y*(1 - y) + c*r*z*(1 - z) + c*r*x*(1 - x)"
z = "(1 - 2*c)*r*z*(1 - z) + c*r*x*(1 - x) + c*r*y*(1 - y)"
[model.start]
x = "1 - 1/r"
y = "1 - 1/r"
z = "1 - 1/r"
[branch]
parameter = "r"
from = 1.2
to = 3.6
)case",
                     coupling);
}

/// A branch is met at p = way; on both a pair is on the axis, or on the circle, at p = 0.
std::string pair_beside(double way, bool is_map) {
  const std::string cubic = "(x^2 + y^2)";
  const std::string flow = "x = \"p*x - y - x*" + cubic + "\"\ny = \"x + p*y - y*" + cubic + "\"\nw = \"";
  const std::string map = "x = \"(1 + p)*(0.6*x - 0.8*y) - x*" + cubic +
                          "\"\ny = \"(1 + p)*(0.8*x + 0.6*y) - y*" + cubic + "\"\nw = \"w + ";
  return fmt::format(
      "{}[model.parameters]\np = -0.5\nd = {:.17g}\n[model.equations]\n{}(p - d)*w - "
      "w^2\"\n[branch]\nparameter = "
      "\"p\"\nfrom = -0.5\nto = 0.5\nswitching = true\n",
      is_map ? "[model]\nkind = \"map\"\n" : "", way, is_map ? map : flow);
}

}  // namespace

TEST_CASE("Two multipliers that are -1 at once behind a point where one was are told, whatever the steps are",
          "[cases]") {
  const double max_step = GENERATE(0.3, 0.1, 0.03, 0.013);
  const Settings steps = {fmt::format("continuation.max_step={}", max_step)};
  constexpr double as_double = 1e-6;  // zeros of squares are told by the root of rounding
  for (const double way : {0.2, 0.04, 0.01, 1e-3}) {
    CAPTURE(max_step, way);
    check_values(all_values_at(traced_of(doublings(way), steps), PointType::period_doubling, "p"), {0, way},
                 as_double);
  }
  for (const double coupling : {0.05, 0.02, 1e-3}) {
    CAPTURE(max_step, coupling);
    check_values(all_values_at(traced_of(coupled_maps(coupling), steps), PointType::period_doubling, "r"),
                 {3, 2 + 1 / (1 - 3 * coupling)}, as_double);
  }
}

TEST_CASE("A pair that crosses in the first step of a branch that leaves another is told", "[cases]") {
  const double max_step = GENERATE(0.3, 0.1, 0.03);
  for (const double way : {1e-2, 1e-3, 1e-4, 1e-6, -1e-3}) {
    for (const bool is_map : {false, true}) {
      CAPTURE(max_step, way, is_map);
      const auto all =
          traced_of(pair_beside(way, is_map), {fmt::format("continuation.max_step={}", max_step)});
      check_values(all_values_at(all, is_map ? PointType::neimark_sacker : PointType::hopf, "p"), {0, 0},
                   1e-9);
    }
  }
}

TEST_CASE("Cycles that shrink onto a point end there, whatever else is met in it", "[cases]") {
  const std::string coupled = R"case(
[model.parameters]
p = -1
m = 0.1
[model.equations]
x = "p*x - y + u - x*(x^2 + y^2)"
y = "x + p*y + v - y*(x^2 + y^2)"
u = "p*u - v - m*x - u*(u^2 + v^2)"
v = "u + p*v - m*y - v*(u^2 + v^2)"
[branch]
parameter = "p"
from = -0.9
to = 0.9
switching = true
)case";
  const double max_step = GENERATE(0.2, 0.1, 0.07, 0.05, 0.03);
  int shrunk = 0;
  for (const TracedBranch& one :
       cycles_of(traced_of(coupled, {fmt::format("continuation.max_step={}", max_step)}))) {
    CAPTURE(max_step, one.branch.explanation);
    CHECK(one.branch.stop != Stop::requested);
    for (const BranchPoint& point : one.branch.points) CHECK(point.label.empty());
    if (one.branch.stop != Stop::left_regime) continue;
    ++shrunk;
    CHECK(one.branch.points.back().type == PointType::end);
    CHECK_THAT(one.branch.points.back().parameters(0), WithinAbs(0, 1e-8));
  }
  CHECK(shrunk >= 1);
}

TEST_CASE("Where branches leave along one direction it is said that not all are followed", "[cases]") {
  const std::string text = R"case(
[model.parameters]
p = -1
[model.equations]
x = "p*x - x^2"
y = "p*y - y^{}"
[branch]
parameter = "p"
from = -1
to = 1
switching = true
)case";
  for (const int power : {2, 3}) {  // (0, +-sqrt(p)) and (p, +-sqrt(p)) leave along y
    CAPTURE(power);
    const auto all = traced_of(fmt::format(fmt::runtime(text), power));
    const bool is_whole = power == 2;
    CHECK(all.size() == (is_whole ? 7 : 3));
    CHECK_THAT(all[0].branch.warning,
               ContainsSubstring(is_whole ? "" : "not all branches that leave there are told"));
    CHECK(all[0].branch.warning.empty() == is_whole);
  }
}
