// Cycles by harmonic balance and tori, in cases: against collocation and motions in time.

#include <span>

#include "cycle_cases.hpp"
#include "draws.hpp"

namespace arcslip::testing::balance_cases {

namespace {

const std::string brusselator = R"case(
[model.parameters]
A = 1
B = 1.5
[model.equations]
x = "A - (B + 1)*x + x^2*y"
y = "B*x - x^2*y"
[model.start]
x = "A"
y = "B/A"
[branch]
parameter = "B"
from = 1.5
to = 2.4
switching = true
)case";

const std::string van_der_pol = R"case(
[model.parameters]
mu = -0.5
[model.equations]
x = "v"
v = "(mu - x^2)*v - x + 0.1*x^2"
[branch]
parameter = "mu"
from = -0.5
to = 1
switching = true
)case";

Settings with(Settings settings, const std::string& discretisation) {
  settings.push_back("cycles.discretisation=" + discretisation);
  settings.push_back("cycles.tolerance=1e-9");
  return settings;
}

}  // namespace

TEST_CASE("Balanced cycles end where those on intervals do", "[balance]") {
  for (const std::string& text : {brusselator, van_der_pol}) {
    const auto meshed =
        cycles_of(traced_of(text, with({"cycles.degree=7", "cycles.intervals=60"}, "collocation")));
    const auto balanced = cycles_of(traced_of(text, with({}, "balance")));
    REQUIRE(meshed.size() == 1);
    REQUIRE(balanced.size() == 1);
    REQUIRE(cycles(balanced[0])->is_trigonometric());
    CHECK(balanced[0].branch.stop == Stop::reached_end);
    const BranchPoint& end = balanced[0].branch.points.back();
    const BranchPoint& same = meshed[0].branch.points.back();
    for (const std::string name : {"T", "x_max", "x_min", "norm"})
      CHECK_THAT(value(balanced[0], end, name), WithinAbs(value(meshed[0], same, name), 1e-8));
    CHECK(end.unstable == same.unstable);
    const auto log = [](const TracedBranch& one, const BranchPoint& point) {
      return cycles(one)->log_multipliers(point.unknowns, point.parameters, point.regime)(0).real();
    };
    CHECK_THAT(log(balanced[0], end), WithinAbs(log(meshed[0], same), 1e-8));
  }
}

TEST_CASE("Special points of balanced cycles are those on intervals", "[balance]") {
  struct Sought {
    std::string file, parameter;
    PointType type;
    Settings settings;
  };
  const std::vector<Sought> all = {
      {"forced_duffing", "W", PointType::fold, {}},
      {"oscillator_tori", "nu", PointType::neimark_sacker, {}},
      {"oscillator_tori", "nu", PointType::branch_point, {}},
      {"oscillator_tori", "nu", PointType::period_doubling, {}},
      {"roessler_cascade", "c", PointType::period_doubling, {"cycles.doublings=0", "branch.to=3"}}};
  for (const Sought& sought : std::span(all).first(sanitized ? 2 : all.size())) {
    INFO(sought.file);
    const Run meshed(sought.file, with(sought.settings, "collocation"));
    const Run balanced(sought.file, with(sought.settings, "balance"));
    const auto wanted = all_values_at(cycles_of(meshed.traced), sought.type, sought.parameter);
    REQUIRE(!wanted.empty());
    check_values(all_values_at(cycles_of(balanced.traced), sought.type, sought.parameter), wanted, 1e-8);
  }
}

TEST_CASE("Tori of Langford's flow are what its motion in time is", "[tori][numbers]") {
  // by scipy's DOP853 with tolerances of 1e-12 over a time of 4000, with means weighted by e^(-1/(t (1 - t)))
  struct Seen {
    double rho, second, norm;
  };
  const std::vector<Seen> seen = {{0.595, 1.5170531891466115, 1.1590350646764878},
                                  {0.59, 1.510694644583633, 1.161688448641022}};
  const Run run("langford_tori", {"continuation.stop_at=[0.595]"});
  const TracedBranch& tori = run.traced.back();
  REQUIRE(cycles(tori) == nullptr);
  CHECK(tori.branch.stop == Stop::reached_end);
  for (const Seen& one : seen) {
    const auto at = std::find_if(
        tori.branch.points.begin(), tori.branch.points.end(),
        [&](const BranchPoint& point) { return std::abs(point.parameters(0) - one.rho) < 1e-12; });
    REQUIRE(at != tori.branch.points.end());
    CHECK_THAT(value(tori, *at, "omega_1"), WithinAbs(3.5, 1e-8));
    CHECK_THAT(value(tori, *at, "rotation"), WithinAbs(one.second / 3.5, 1e-8));
    CHECK_THAT(value(tori, *at, "norm"), WithinAbs(one.norm, 1e-8));
  }
}

TEST_CASE("A torus that turns about an axis is a cycle beside it", "[tori]") {
  const Run run("langford_tori", {"model.parameters.epsilon=0", "branch.to=0.5", "cycles.tolerance=1e-7"});
  const TracedBranch& tori = run.traced.back();
  REQUIRE(cycles(tori) == nullptr);
  const auto plane = cycles_of(traced_of(R"case(
[model.parameters]
rho = 0.8
[model.equations]
r = "(z - 0.7)*r"
z = "0.6 + z - z^3/3 - r^2*(1 + rho*z)"
[model.start]
r = 0.9
z = 0.7
[cycles]
tolerance = 1e-10
[branch]
parameter = "rho"
from = 0.8
to = 0.5
switching = true
)case"));
  REQUIRE(plane.size() == 1);
  const BranchPoint& cycle = plane[0].branch.points.back();
  const BranchPoint& torus = tori.branch.points.back();
  CHECK_THAT(value(tori, torus, "omega_2"), WithinAbs(2 * pi / value(plane[0], cycle, "T"), 1e-8));
  CHECK_THAT(value(tori, torus, "x_max"), WithinAbs(value(plane[0], cycle, "r_max"), 1e-7));
  CHECK_THAT(value(tori, torus, "y_min"), WithinAbs(-value(plane[0], cycle, "r_max"), 1e-7));
  CHECK_THAT(value(tori, torus, "z_max"), WithinAbs(value(plane[0], cycle, "z_max"), 1e-7));
  CHECK_THAT(value(tori, torus, "z_min"), WithinAbs(value(plane[0], cycle, "z_min"), 1e-7));
  CHECK_THAT(value(tori, torus, "norm"), WithinAbs(value(plane[0], cycle, "norm"), 1e-8));
}

TEST_CASE("Cycles of sparse systems are not balanced", "[balance]") {
  const auto all = traced_of(
      "[system]\nmodel = \"brusselator_1d\"\nintervals = 20\n[branch]\nparameter = \"L\"\nfrom = 0.45\nto = "
      "0.6\nswitching = true\n[cycles]\ndiscretisation = \"balance\"\n");
  REQUIRE(all.size() == 1);
  CHECK(all[0].branch.stop == Stop::no_start);
  CHECK_THAT(all[0].branch.explanation, ContainsSubstring("held on intervals, not by balance"));
}

}  // namespace arcslip::testing::balance_cases
