// What is told does not hang on the units in which a model is written.

#include "arcslip/results/results.hpp"
#include "cycle_cases.hpp"

namespace {

using namespace arcslip;
using namespace arcslip::testing;
using Catch::Matchers::ContainsSubstring;

/// Rosenzweig's and MacArthur's predators and prey, their densities in a unit of s.
const std::string predators = R"case(
[model.parameters]
K = 1
s = 1
[model.equations]
x = "x*(1 - x/(s*K)) - x/s*y/(1 + x/s)"
y = "0.5*x/s*y/(1 + x/s) - 0.1*y"
[model.start]
x = "0.25*s"
y = "0.9*s"
[branch]
parameter = "K"
from = 1
to = 3
)case";

/// The Brusselator, its concentrations in a unit of s and its parameter in one of r.
const std::string brusselator = R"case(
[model.parameters]
s = 1
r = 1
B = 1.5
[model.definitions]
b = "B/r"
[model.equations]
x = "s - (b + 1)*x + x^2*y/s^2"
y = "b*x - x^2*y/s^2"
[model.start]
x = "s"
y = "s*B/r"
)case";

std::vector<TracedBranch> in_units(double s, double r, const Settings& more = {}) {
  Settings settings = more;
  settings.push_back(fmt::format("model.parameters.s={}", s));
  settings.push_back(fmt::format("model.parameters.r={}", r));
  return traced_of(
      brusselator + fmt::format("[model.scale]\nx = {}\ny = {}\n", s, s) +
          fmt::format("[branch]\nparameter = \"B\"\nfrom = {}\nto = {}\nswitching = true\n", 1.5 * r, 4 * r),
      settings);
}

}  // namespace

TEST_CASE("Lyapunov's coefficient goes with the square of the unit", "[cases][numbers]") {
  for (const double s : {1.0, 1e-3, 1e-6, 1e6}) {
    CAPTURE(s);
    const auto traced = traced_of(predators, {fmt::format("model.parameters.s={}", s)});
    const auto summary = summarize(0, traced.front());
    REQUIRE(summary["special"].size() == 3);
    CHECK_THAT(summary["special"][1]["K"].get<double>(), WithinRel(1.5, 1e-12));
    CHECK_THAT(summary["special"][1]["lyapunov"].get<double>() * s * s, WithinRel(-std::sqrt(0.6), 1e-12));
  }
}

TEST_CASE("Cycles of a model in small units are those in usual ones", "[cases][cycles]") {
  const auto usual = in_units(1, 1);
  REQUIRE(usual.size() == 2);
  const std::vector<std::pair<double, double>> units{{1e-4, 1}, {1e-9, 1}, {1, 1e-8}, {1e-7, 1e-5}};
  for (const auto& [s, r] : units) {
    CAPTURE(s, r);
    const auto small = in_units(s, r);
    REQUIRE(small.size() == 2);
    for (const bool last : {false, true}) {
      const auto at = [=](const TracedBranch& one, const char* name) {
        return value(one, last ? one.branch.points.back() : one.branch.points.front(), name);
      };
      CHECK_THAT(at(small[1], "B") / r, WithinRel(at(usual[1], "B"), 1e-6));
      CHECK_THAT(at(small[1], "T"), WithinRel(at(usual[1], "T"), 1e-6));
      CHECK_THAT(at(small[1], "x_max") / s, WithinRel(at(usual[1], "x_max"), 1e-6));
    }
  }
  CHECK_THROWS_WITH(in_units(1, 1, {"model.scale.z=1"}),
                    ContainsSubstring("model.scale.z: there is no unknown or parameter of this name"));
  CHECK_THROWS_WITH(in_units(1, 1, {"model.scale.x=0"}), ContainsSubstring("model.scale.x"));
}

TEST_CASE("Orbits that are at rest to begin with, or grow far beyond that, are held on few intervals",
          "[cases][cycles]") {
  const auto forced = traced_of(R"case(
[model]
kind = "forced"
period = "2*pi"
[model.parameters]
F = 0
[model.equations]
v = "0.3 - v"
w = "v - 0.3 - w + F*sin(t)"
[model.start]
v = 0.3
[branch]
parameter = "F"
from = 0
to = 0.1
)case");
  REQUIRE(forced.size() == 1);
  CHECK(forced[0].branch.stop == continuation::Stop::reached_end);
  CHECK_THAT(value(forced[0], forced[0].branch.points.back(), "w_max"),
             WithinRel(0.1 / std::sqrt(2.0), 1e-7));

  const auto vertical = traced_of(R"case(
[model]
kind = "boundary"
interval = { s = [0, 1] }
conditions = ["u_left", "u_right", "w_left - a", "w_right + a"]
free = ["a"]
[model.parameters]
a = 0
b = 0
[model.equations]
u = "v"
v = "-b*u"
w = "-v^2/2 - b"
[branch]
parameter = "b"
from = 0
to = 20
switching = true
)case");
  REQUIRE(vertical.size() == 2);
  CHECK(vertical[1].branch.stop == continuation::Stop::unbounded);
  CHECK_THAT(vertical[1].branch.points.back().parameters(0), WithinRel(pi * pi, 1e-9));
}
