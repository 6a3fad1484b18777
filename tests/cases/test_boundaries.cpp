#include <cmath>

#include "cases/cycles.hpp"
#include "cycle_cases.hpp"
#include "results/orbit_table.hpp"

using namespace arcslip;
using namespace arcslip::testing;

namespace {

constexpr double bratu_fold = 3.513830719125;

const std::string on_length =
    "[model]\n"
    "kind = \"boundary\"\n"
    "interval = { x = [0, \"L\"] }\n"
    "parameters = { L = 0.5, lambda = 1.0 }\n"
    "equations = { u = \"v\", v = \"-lambda*exp(u)\" }\n"
    "conditions = [\"u_left\", \"u_right\"]\n"
    "[branch]\n"
    "parameter = \"L\"\n"
    "from = 0.5\n"
    "to = 3.0\n";

/// -u'' = mu u with the integral of u^2 given: mu is free.
const std::string mode =
    "[model]\n"
    "kind = \"boundary\"\n"
    "interval = { x = [\"-half\", \"half\"] }\n"
    "parameters = { mu = 9.0, half = 0.5, square = 1.0 }\n"
    "definitions = { heat = \"mu*u\" }\n"
    "equations = { u = \"v\", v = \"-heat\" }\n"
    "conditions = [\"u_left\", \"u_right\"]\n"
    "integrals = [\"u^2 - square/(2*half)\"]\n"
    "free = [\"mu\"]\n"
    "start = { u = \"1.4*cos(pi*x/(2*half))\", v = \"-4*sin(pi*x)\" }\n"
    "[branch]\n"
    "parameter = \"half\"\n"
    "from = 0.5\n"
    "to = 2.0\n";

}  // namespace

TEST_CASE("Case files of boundary value problems have the points of their closed forms", "[boundaries]") {
  const Settings fine{"cycles.intervals=60", "cycles.tolerance=1e-9"};
  const auto bratu = Run("bratu_boundary", fine).traced;
  check_values(all_values_at(bratu, PointType::fold, "lambda"), {bratu_fold}, 1e-9);
  CHECK(bratu[0].branch.complete());

  const auto column = Run("buckling_boundary", fine).traced;
  REQUIRE(column.size() == 4);
  check_values(values_at(column[0], PointType::branch_point, "P"), {pi * pi, 4 * pi * pi, 9 * pi * pi}, 1e-9);
  for (std::size_t k = 1; k <= 3; ++k) {
    CHECK(column[k].branch.complete());
    const auto& points = column[k].branch.points;
    for (const auto* end : {&points.front(), &points.back()}) {
      CHECK(end->parameters(0) == 100);
      const double angle = std::abs(value(column[k], *end, "angle_left"));  // P = (2 k K(sin(angle/2)))^2
      const double root = 2 * static_cast<double>(k) * std::comp_ellint_1(std::sin(angle / 2));
      CHECK_THAT(root * root, WithinRel(100, 1e-8));
    }
  }
  CHECK(orbits_header(column[1]) == "branch,point,type,s,angle,moment\n");
}

TEST_CASE("Loads on which a column is asked for may be those at which it buckles", "[boundaries]") {
  const Settings to_first{"branch.switching=false", "branch.to=9.869604401089358"};
  const Settings from_first{"branch.switching=false", "branch.from=9.869604401089358", "branch.to=20.0"};
  const Settings past_first{"branch.switching=false", "branch.to=20.0",
                            "continuation.stop_at=[9.869604401089358]"};
  for (const Settings& settings : {to_first, from_first, past_first}) {
    const auto column = Run("buckling_boundary", settings).traced;
    REQUIRE(column.size() == 1);
    CHECK(column[0].branch.complete());
    check_values(values_at(column[0], PointType::branch_point, "P"), {pi * pi}, 1e-9);
  }
}

TEST_CASE("Where the real solutions of Bratu's problem end complex ones go on", "[boundaries]") {
  const auto all = traced_of(  // AUTO-07p, demo ezp
      "[model]\nkind = \"boundary\"\ninterval = { x = [0, 1] }\nparameters = { lambda = 0.1 }\n"
      "equations = { u = \"v\", v = \"-lambda*exp(u)*cos(w)\", w = \"z\", z = \"-lambda*exp(u)*sin(w)\" }\n"
      "conditions = [\"u_left\", \"u_right\", \"w_left\", \"w_right\"]\n"
      "[branch]\nparameter = \"lambda\"\nfrom = 0.1\nto = 5\nswitching = true\n");
  REQUIRE(all.size() == 2);
  check_values(all_values_at(all, PointType::branch_point, "lambda"), {bratu_fold}, 1e-9);
  Complex theta(1.2, 0.5);  // lambda = 8 theta^2/cosh(theta)^2
  for (int i = 0; i < 50; ++i)
    theta -= (8.0 * theta * theta - 5.0 * std::pow(std::cosh(theta), 2)) /
             (16.0 * theta - 10.0 * std::cosh(theta) * std::sinh(theta));
  const Complex slope = 4.0 * theta * std::tanh(theta);
  for (const auto* end : {&all[1].branch.points.front(), &all[1].branch.points.back()}) {
    CHECK(end->parameters(0) == 5);
    CHECK_THAT(value(all[1], *end, "v_left"), WithinRel(slope.real(), 1e-9));
    CHECK_THAT(std::abs(value(all[1], *end, "z_left")), WithinRel(std::abs(slope.imag()), 1e-9));
  }
}

TEST_CASE("An interval may depend on a parameter, and folds are followed in two", "[boundaries]") {
  const auto over_length = traced_of(on_length, {"cycles.tolerance=1e-9"});
  check_values(all_values_at(over_length, PointType::fold, "L"), {std::sqrt(bratu_fold)}, 1e-9);
  const auto rows = orbit_rows(0, over_length[0]);
  CHECK(rows.find("0,0,start,0.5,") != std::string::npos);  // the right end
  const auto curve =
      traced_of(replaced(on_length, "parameter = \"L\"\nfrom = 0.5\nto = 3.0\n",
                         "curve = \"fold\"\nparameters = [\"L\", \"lambda\"]\nwindow = [0.5, 3]\nfrom = "
                         "0.6\nto = 2\n"));
  REQUIRE(curve.size() == 1);
  REQUIRE(curve[0].branch.points.size() > 5);
  for (const BranchPoint& point : curve[0].branch.points) {
    const double length = value(curve[0], point, "L");
    CHECK_THAT(value(curve[0], point, "lambda") * length * length, WithinRel(bratu_fold, 1e-6));
  }
}

TEST_CASE("A parameter that an integral frees is a column", "[boundaries]") {
  const auto all = traced_of(mode, {"cycles.tolerance=1e-9"});
  REQUIRE(all.size() == 1);
  CHECK(all[0].branch.complete());
  for (const BranchPoint& point : all[0].branch.points) {
    const double half = value(all[0], point, "half");
    CHECK_THAT(value(all[0], point, "mu"), WithinRel(std::pow(pi / (2 * half), 2), 1e-9));
    CHECK_THAT(value(all[0], point, "u_max"), WithinRel(std::sqrt(1 / half), 1e-7));
  }
}

TEST_CASE("Mistakes in boundary value problems are told in one line", "[boundaries]") {
  const Mistake mistakes[] = {
      {"conditions = [\"u_left\", \"u_right\"]", "conditions = [\"u_left\"]", ":7:14", "model.conditions",
       "expected 3 conditions and integrals, one for each of 2 unknowns and 1 free parameter",
       "got 1 condition and 1 integral"},
      {"free = [\"mu\"]", "", ":7:14", "model.conditions", "one for each of 2 unknowns and 0 free parameters",
       "got 2 conditions and 1 integral"},
      {"\"u_right\"]", "\"u_rihgt\"]", ":7:25", "model.conditions[1]", "there are u_left, v_left", "u_rihgt"},
      {"\"u_right\"]", "\"u\"]", ":7:25", "model.conditions[1]", "expected u_left or u_right", ""},
      {"\"u_right\"]", "\"heat\"]", ":7:25", "model.conditions[1]", "equations and integrals alone", ""},
      {"\"u_right\"]", "\"u_left - x\"]", ":7:25", "model.conditions[1]",
       "conditions have values at the ends", ""},
      {"\"u_right\"]", "[]]", ":7:25", "model.conditions[1]", "a formula as a string, or a number", ""},
      {"[\"u_left\", \"u_right\"]", "\"u_left\"", ":7:14", "model.conditions", "an array of formulas",
       "got \"u_left\""},
      {"free = [\"mu\"]", "free = [\"nu\"]", ":9:9", "model.free[0]", "among mu, half, square", "got \"nu\""},
      {"free = [\"mu\"]", "free = [\"mu\", \"mu\"]", ":9:", "model.free", "mu twice", ""},
      {"{ x = [\"-half\", \"half\"] }", "{ x = [0, 1, 2] }", ":3:12", "model.interval", "{ x = [0, 1] }", ""},
      {"{ x = [\"-half\", \"half\"] }", "[0, 1]", ":3:12", "model.interval", "{ x = [0, 1] }", ""},
      {"{ x = [\"-half\", \"half\"] }", "{ u = [\"-half\", \"half\"] }", ":3:", "model.interval.u",
       "has this name already", ""},
      {"{ x = [\"-half\", \"half\"] }", "{ x = [0, \"long\"] }", ":3:", "model.interval.x[1]",
       "unknown name \"long\"", "there are"},
      {"[\"-half\", \"half\"]", "[2, 2.0]", ":3:", "model.interval.x", "two different ends", "got 2 and 2"},
      {"start = { u = \"1.4", "start = { u = \"s*1.4", ":10:", "model.start.u", "unknown name \"s\"",
       "there are x, mu, half, square"},
      {"interval = { x = [\"-half\", \"half\"] }\n", "", ":1:", "model.interval", "missing", ""},
      {"u^2 - square", "w^2 - square", ":8:14", "model.integrals[0]", "unknown name \"w\"", ""},
      {"kind = \"boundary\"", "kind = \"flow\"", ":3:12", "model.interval", "only of kind = \"boundary\"",
       ""},
      {"parameter = \"half\"", "parameter = \"mu\"", ":12:13", "branch.parameter", "\"half\" or \"square\"",
       "got \"mu\""},
      {"to = 2.0\n", "to = 2.0\nstart = 1.0\nall_solutions = true\n", ":16:", "branch.all_solutions",
       "not of orbits", ""},
      {"to = 2.0\n", "to = 2.0\n[cycles]\nsettle = 3\n", ":16:10", "cycles.settle", "only of flows", ""},
  };
  for (const Mistake& mistake : mistakes)
    check_message(error_of([&] { case_texts::read_text(replaced(mode, mistake.from, mistake.to)); }),
                  mistake);
}
