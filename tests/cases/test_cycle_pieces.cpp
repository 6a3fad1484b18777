// Cycles that are put together of pieces, between borders.

#include <algorithm>
#include <cmath>

#include "cases/cycles.hpp"
#include "cycle_cases.hpp"

namespace {

using namespace arcslip;
using namespace arcslip::testing;

/// Roessler's flow, cut where x = 2, which changes nothing.
std::string cut_roessler(const std::string& cycle) {
  return "[model]\nkind = \"piecewise\"\nparameters = { c = 2.5 }\ncycle = [" + cycle +
         "]\nequations = { x = \"-y - z\", y = \"x + 0.2*y\", z = \"0.2 + z*(x - c)\" }\nstart = { x = 2, y "
         "= -3 "
         "}\n[model.pieces.right]\nuntil = \"x - 2\"\n[model.pieces.left]\nuntil = \"x - "
         "2\"\n[cycles]\nsettle = "
         "400\ndegree = 7\nintervals = 40\n[branch]\nparameter = \"c\"\nfrom = 2.5\nto = 3.5\n";
}

/// The speeds with which an oscillator can hit its wall once in two periods of its force: x and v of
/// cos(w t + phase) are linear in (cos, sin) of the phase, whose squares add up to 1.
struct OneImpact {
  double w, r, zeta, gap;

  /// cos^2 + sin^2 - 1 at this speed V.
  double miss(double speed) const {
    const double period = 4 * pi / w;
    const double own = std::sqrt(1 - zeta * zeta);
    const double decay = std::exp(-zeta * period);
    const double c = decay * std::cos(own * period);
    const double s = decay * std::sin(own * period) / own;
    Eigen::Matrix2d free;  // x and v after T
    free << c + zeta * s, s, -s, c - zeta * s;
    const double spring = 1 - w * w;
    const double damper = 2 * zeta * w;
    const double size = spring * spring + damper * damper;
    Eigen::Matrix2d forced;  // x and v at t = 0 by cos and sin of the phase
    forced << spring / size, damper / size, w * damper / size, -w * spring / size;
    const Eigen::Vector2d begin(gap, -r * speed);
    const Eigen::Vector2d end(gap, speed);
    const Eigen::Matrix2d change = (Eigen::Matrix2d::Identity() - free) * forced;
    const Eigen::Vector2d phase = change.lu().solve(end - free * begin);
    return phase.squaredNorm() - 1;
  }
};

}  // namespace

TEST_CASE("An oscillator that hits a wall does so as in closed form", "[cycles][pieces]") {
  const auto all =
      Run("impact_oscillator", {"branch.switching=false", "cycles.degree=7", "cycles.tolerance=1e-9"}).traced;
  REQUIRE(all.size() == 1);
  const TracedBranch& traced = all[0];
  const continuation::OrbitProblem* orbits = orbits_of(traced);
  REQUIRE(orbits != nullptr);
  for (const BranchPoint& point : traced.branch.points) {
    const OneImpact closed{value(traced, point, "w"), 0.8, 0.05, 0.5};
    const Matrix orbit = orbits->told_orbit(point.unknowns);
    const double speed = orbit(1, orbit.cols() - 1);
    CHECK_THAT(orbit(0, orbit.cols() - 1), WithinAbs(0.5, 1e-9));
    CHECK_THAT(closed.miss(speed), WithinAbs(0, 1e-7));
    CHECK_THAT(value(traced, point, "T_free"), WithinAbs(4 * pi / closed.w, 1e-10));
    const ComplexVector logs = orbits->log_multipliers(point.unknowns, point.parameters, point.regime);
    REQUIRE(logs.size() == 2);
    CHECK_THAT(logs.sum().real(), WithinAbs(2 * std::log(0.8) - 2 * 0.05 * 4 * pi / closed.w, 1e-9));
  }
  CHECK(points(traced, PointType::period_doubling).size() == 2);
  CHECK(traced.branch.stop == Stop::left_regime);
  const auto folds = points(traced, PointType::fold);
  REQUIRE(folds.size() == 2);
  for (const BranchPoint& fold : folds) {
    const OneImpact closed{value(traced, fold, "w"), 0.8, 0.05, 0.5};
    const Matrix orbit = orbits->told_orbit(fold.unknowns);
    const double speed = orbit(1, orbit.cols() - 1);  // where the quadratic in V has one root
    CHECK_THAT((closed.miss(speed + 1e-4) - closed.miss(speed - 1e-4)) / 2e-4, WithinAbs(0, 1e-7));
  }
}

TEST_CASE("A ball on a shaking table comes to its bounce whichever way it is dropped", "[cycles][pieces]") {
  const std::string ball =
      "[model]\nkind = \"piecewise\"\nperiod = \"2*pi\"\nparameters = { g = 0.6, r = 0.8 }\n"
      "equations = { x = \"v\", v = \"-1\" }\n"
      "[model.pieces.fly]\nuntil = \"x - g*sin(t)\"\nreset = { v = \"-r*v + (1 + r)*g*cos(t)\" }\n"
      "[branch]\nparameter = \"g\"\nfrom = 0.6\nto = 0.62\n";
  for (const auto& [x, v] : {std::pair("3.0", "-2.2"), std::pair("2.9", "-2.0")}) {
    for (const char* settle : {"100", "150"}) {
      CAPTURE(x, v, settle);
      const auto all = traced_of(
          fmt::format("{}[model.start]\nx = {}\nv = {}\n[cycles]\nsettle = {}\n", ball, x, v, settle));
      REQUIRE(all.size() == 1);
      const BranchPoint& first = all[0].branch.points.front();
      const Matrix orbit = orbits_of(all[0])->told_orbit(first.unknowns);
      CHECK_THAT(orbit(1, 0), WithinAbs(pi, 1e-8));
      CHECK_THAT(orbit(1, orbit.cols() - 1), WithinAbs(-pi, 1e-8));
      const Vector t = orbits_of(all[0])->times(first.unknowns, first.parameters, first.regime);
      for (const Index end : {Index{0}, t.size() - 1})  // on the table
        CHECK_THAT(orbit(0, end), WithinAbs(0.6 * std::sin(t(end)), 1e-8));
    }
  }
}

TEST_CASE("A mass on a belt sticks and slips as in closed form until it slides", "[cycles][pieces]") {
  const auto all = Run("stick_slip", {"cycles.degree=7", "cycles.tolerance=1e-9"}).traced;
  REQUIRE(all.size() == 1);
  const TracedBranch& traced = all[0];
  for (const BranchPoint& point : traced.branch.points) {
    const double d = value(traced, point, "mu_s") - 0.4;
    if (d < 1e-3) continue;  // it slips along its border, in the end
    CHECK_THAT(value(traced, point, "T_slip"), WithinAbs(pi + 2 * std::atan2(0.5, d), 1e-8));
    CHECK_THAT(value(traced, point, "T_stick"), WithinAbs(2 * d / 0.5, 1e-8));
    CHECK_THAT(value(traced, point, "x_max"), WithinAbs(0.4 + std::hypot(d, 0.5), 1e-8));
    CHECK_THAT(value(traced, point, "v_min"), WithinAbs(-std::hypot(d, 0.5), 1e-8));
  }
  const BranchPoint& last = traced.branch.points.back();
  CHECK(traced.branch.stop == Stop::left_regime);
  CHECK_THAT(value(traced, last, "mu_s"), WithinAbs(0.4, 1e-6));
}

TEST_CASE("A smooth flow that is cut into pieces stays what it is", "[cycles][pieces]") {
  const auto once = traced_of(cut_roessler("\"right\", \"left\""));
  REQUIRE(once.size() == 1);
  const auto doublings = points(once[0], PointType::period_doubling);
  REQUIRE(doublings.size() == 1);
  CHECK_THAT(value(once[0], doublings[0], "c"), WithinAbs(2.832445030, 1e-7));
  CHECK_THAT(value(once[0], doublings[0], "T"), WithinAbs(5.76982002, 1e-6));

  const auto twice = traced_of(cut_roessler("\"right\", \"left\", \"right\", \"left\""),
                               {"branch.from=3.0", "branch.to=3.9", "model.parameters.c=3"});
  REQUIRE(twice.size() == 1);
  const auto next = points(twice[0], PointType::period_doubling);
  REQUIRE(next.size() == 1);
  CHECK_THAT(value(twice[0], next[0], "c"), WithinAbs(3.83735815, 1e-6));
  CHECK(value(twice[0], next[0], "T_left_2") > 0);
}

TEST_CASE("Systems of pieces are refused where they are none", "[pieces]") {
  const std::string begin =
      "[model]\nkind = \"piecewise\"\nparameters = { a = 1.0 }\nequations = { x = \"v\", v = \"-x\" }\n";
  const std::string branch = "[branch]\nparameter = \"a\"\nfrom = 1\nto = 2\n";
  CHECK_THROWS_WITH(traced_of(begin + branch), ContainsSubstring("model.pieces"));
  CHECK_THROWS_WITH(traced_of(begin + "[model.pieces.one]\nreset = { x = \"0\" }\n" + branch),
                    ContainsSubstring("model.pieces.one.until"));
  CHECK_THROWS_WITH(
      traced_of(begin + "[model.pieces.one]\nuntil = \"x\"\nreset = { w = \"0\" }\n" + branch),
      ContainsSubstring("model.pieces.one.reset.w") && ContainsSubstring("no equation of this name"));
  CHECK_THROWS_WITH(traced_of(begin + "[model.pieces.one]\nuntil = \"x - t\"\n" + branch),
                    ContainsSubstring("is the time, which formulas have beside a period alone"));
  CHECK_THROWS_WITH(traced_of(begin + "period = 1\n[model.pieces.one]\nuntil = \"y\"\n" + branch),
                    ContainsSubstring("there are x, v, a, t"));
  CHECK_THROWS_WITH(traced_of(begin + "cycle = [\"two\"]\n[model.pieces.one]\nuntil = \"x\"\n" + branch),
                    ContainsSubstring("model.cycle"));
  const auto none = traced_of(begin + "[model.pieces.one]\nuntil = \"x - 5\"\n" + branch);
  REQUIRE(none.size() == 1);
  CHECK(none[0].branch.stop == Stop::no_start);
  CHECK_THAT(none[0].branch.explanation,
             ContainsSubstring("the piece one does not come to its border within 10000"));
  CHECK_THROWS_WITH(
      traced_of("[model]\nkind = \"forced\"\nparameters = { a = 1.0 }\nequations = { x = \"-x\" "
                "}\n" +
                branch),
      ContainsSubstring("model.period"));
}
