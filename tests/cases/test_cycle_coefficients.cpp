// Which way what leaves cycles and fixed points of maps goes: against normal forms in other coordinates.

#include "arcslip/continuation/cycles/multiplier_form.hpp"
#include "arcslip/problems/formulas/formula_problem.hpp"
#include "arcslip/results/results.hpp"
#include "cycle_cases.hpp"

namespace {

using namespace arcslip;
using namespace arcslip::testing;

/// A cycle r = 1 of period 2 pi, where x = r cos t, y = r sin t; with terms in r and t of the `square` of
/// what is beside it, whose equations follow.
std::string round_cycle(const std::string& square, const std::string& definitions, const std::string& rest) {
  return "[model.parameters]\nmu = -0.5\n[model.definitions]\nr = \"sqrt(x^2 + y^2)\"\n" + definitions +
         "turn = \"1 + 0.4*" + square + "\"\n[model.equations]\nx = \"x*(1 - r^2 + 0.6*" + square +
         ") - y*turn\"\ny = \"y*(1 - r^2 + 0.6*" + square + ") + x*turn\"\n" + rest +
         "[model.start]\nx = 1\n[cycles]\nsettle = 30\n[branch]\nparameter = \"mu\"\nfrom = -0.5\nto = 0.5\n";
}

/// Of all special points of a type.
std::vector<double> coefficients(const std::vector<TracedBranch>& all, const std::string& type) {
  std::vector<double> found;
  for (const TracedBranch& one : all) {
    const auto summary = summarize(0, one);
    for (const auto& point : summary["special"]) {
      if (point["type"] == type) found.push_back(point.at("coefficient"));
    }
  }
  return found;
}

/// Z' = mu Z - 0.9 Z^3 + 0.7 (r - 1) Z along (cos t/2, sin t/2), seen by (u, v), decaying across it; r - 1 =
/// 0.3 Z^2 on the manifold.
const std::string half_turns = round_cycle(
    "square",
    "cc = \"(1 + x/r)/2\"\nss = \"(1 - x/r)/2\"\ncs = \"y/r/2\"\nsquare = \"u^2*cc + 2*u*v*cs + v^2*ss\"\n"
    "grow = \"mu + 0.7*(r - 1) - 0.9*square\"\nzc = \"u*cc + v*cs\"\nzs = \"u*cs + v*ss\"\n",
    "u = \"grow*zc - (u - zc) - v*turn/2\"\nv = \"grow*zs - (v - zs) + u*turn/2\"\n");

/// The same of a pair that turns at 0.77.
const std::string torus =
    round_cycle("square", "square = \"u^2 + v^2\"\ngrow = \"mu + 0.7*(r - 1) - 0.9*square\"\n",
                "u = \"grow*u - (0.77 + 0.3*square)*v\"\nv = \"grow*v + (0.77 + 0.3*square)*u\"\n");

}  // namespace

TEST_CASE("Period doublings of cycles have the coefficient of their normal form", "[cycles]") {
  const auto found = coefficients(traced_of(half_turns), "period_doubling");
  REQUIRE(found.size() == 1);
  CHECK_THAT(found[0], WithinRel((-0.9 + 0.7 * 0.3) / two_pi, 1e-9));
}

TEST_CASE("Neimark-Sacker points of cycles have the coefficient of their normal form", "[cycles]") {
  const auto found = coefficients(traced_of(torus), "neimark_sacker");
  REQUIRE(found.size() == 1);
  CHECK_THAT(found[0], WithinRel(2 * (-0.9 + 0.7 * 0.3) / two_pi, 1e-9));
}

TEST_CASE("Folds of cycles have the coefficient of their normal form", "[cycles]") {
  for (const char* shear : {"0", "0.3*(r - 1)"}) {  // (r - 1)' = mu - 4 (r - 1)^2
    const auto all =
        traced_of(std::string("[model.parameters]\nmu = 1\n[model.definitions]\nr = \"sqrt(x^2 + y^2)\"\n"
                              "g = \"mu - (r^2 - 1)^2\"\nturn = \"1 + ") +
                  shear +
                  "\"\n[model.equations]\nx = \"x*g - y*turn\"\ny = \"y*g + x*turn\"\n"
                  "[model.start]\nx = 1.4\n[cycles]\nsettle = 30\n"
                  "[branch]\nparameter = \"mu\"\nfrom = 1\nto = -1\n");
    const auto found = coefficients(all, "fold");
    REQUIRE(found.size() == 1);
    CHECK_THAT(found[0], WithinRel(4 / std::sqrt(two_pi), 1e-7));
  }
}

TEST_CASE("Folds of cycles have one coefficient whatever their steps and phases are", "[cycles]") {
  std::vector<double> all;
  for (const double step : {0.05, 0.2}) {
    for (const std::string start : {"0.3", "-1.9"}) {  // of relaxation oscillations (Koper)
      const auto found = coefficients(
          traced_of(
              "[model.parameters]\nk = -10\nlam = -9\n[model.equations]\nx = \"10*(k*y - x^3 + 3*x - lam)\""
              "\ny = \"x - 2*y + z\"\nz = \"y - z\"\n[model.start]\nx = " +
              start +
              "\ny = 1\nz = 1\n[cycles]\nsettle = 30\n[branch]\nparameter = \"lam\"\nfrom = 0\nto = "
              "12\n[continuation]\n"
              "max_step = " +
              std::to_string(step) + "\n"),
          "fold");
      REQUIRE(!found.empty());
      all.push_back(found[0]);
    }
  }
  for (const double one : all) CHECK_THAT(one, WithinRel(all[0], 1e-5));
}

TEST_CASE("Without series the coefficients of cycles come from differences, with their error", "[cycles]") {
  class Plain : public problems::FormulaProblem {
   public:
    using FormulaProblem::FormulaProblem;
    bool series(const Matrix& /*u*/, const Vector& /*p*/, const continuation::Regime& /*regime*/,
                Matrix& /*out*/) const override {
      return false;
    }
  };
  const problems::FormulaSystem system{.parameters = {{"mu", 0}},
                                       .equations = {{"x", "x*(1 - r^2 + 0.6*s) - y*turn"},
                                                     {"y", "y*(1 - r^2 + 0.6*s) + x*turn"},
                                                     {"u", "grow*u - 0.77*v"},
                                                     {"v", "grow*v + 0.77*u"}},
                                       .definitions = {{"r", "sqrt(x^2 + y^2)"},
                                                       {"s", "u^2 + v^2"},
                                                       {"grow", "mu + 0.7*(r - 1) - 0.9*s"},
                                                       {"turn", "1 + 0.4*s"}}};
  const continuation::OrbitMesh mesh(continuation::CollocationRule(5), 24);
  Matrix orbit = Matrix::Zero(4, mesh.nodes());
  for (Index node = 0; node < mesh.nodes(); ++node) {
    orbit(0, node) = std::cos(two_pi * mesh.place(node));
    orbit(1, node) = std::sin(two_pi * mesh.place(node));
  }
  const Vector p = Vector::Zero(1);
  const CycleProblem cycle(std::make_shared<continuation::EquilibriumField>(std::make_shared<Plain>(system)),
                           mesh, orbit, p);
  Vector u(cycle.size());
  u << orbit.reshaped(), two_pi;
  const auto form = continuation::multiplier_form(cycle, PointType::neimark_sacker, {u, p, {}, {}});
  REQUIRE(form);
  CHECK(form->error > 0);
  CHECK(form->error < 1e-6);
  CHECK_THAT(form->coefficient, WithinAbs(2 * (-0.9 + 0.7 * 0.3) / two_pi, 1e-6));
}

TEST_CASE("The coefficient of a flip of Henon's map is that of its 2-cycle", "[cycles]") {
  // In the 2-cycle (x_1 - x_2)^2 = (4 a - 3 (1 - b)^2)/a^2; x = +-q_x w, and the multiplier is -1 - rho
  for (const double b : {0.3, -0.2}) {
    const auto all =
        traced_of("[model]\nkind = \"map\"\n[model.parameters]\na = 0\nb = " + std::to_string(b) +
                  "\n[model.equations]\nx = \"1 - a*x^2 + y\"\ny = \"b*x\"\n[model.start]\n"
                  "x = \"1/(1 - b)\"\ny = \"b/(1 - b)\"\n"
                  "[branch]\nparameter = \"a\"\nfrom = 0\nto = 1.2\n");
    const auto found = coefficients(all, "period_doubling");
    REQUIRE(found.size() == 1);
    const double a = 0.75 * (1 - b) * (1 - b);
    const double by_x = 1 / std::sqrt(1 + b * b);  // of q = (1, -b) over its length
    const auto multiplier = [&](double at) {
      const double x = (b - 1 + std::sqrt((1 - b) * (1 - b) + 4 * at)) / (2 * at);
      return -at * x - std::sqrt(at * at * x * x + b);
    };
    const double slope = -(multiplier(a + 1e-5) - multiplier(a - 1e-5)) / 2e-5;
    CHECK_THAT(found[0], WithinRel(-slope * a * a * by_x * by_x, 1e-8));
  }
}

TEST_CASE("Tori and folds of maps have the coefficients of their normal forms", "[cycles]") {
  // w -> mu w (1 + (-0.3 + 0.2 j) |w|^2 + 0.5 z), z -> z/2 + 0.6 |w|^2, so that z = 1.2 |w|^2; bent
  // coordinates
  const auto all = traced_of(R"case(
[model]
kind = "map"
[model.parameters]
p = -0.2
[model.definitions]
X = "x"
Y = "y - 0.4*x^2"
Z = "z + 0.3*x*Y"
s = "X^2 + Y^2"
g = "(1 + p)*(1 - 0.3*s + 0.5*Z)"
h = "0.2*s"
A = "g*X - h*Y"
B = "g*Y + h*X"
xx = "cos(1.3)*A - sin(1.3)*B"
yy = "sin(1.3)*A + cos(1.3)*B"
zz = "Z/2 + 0.6*s"
[model.equations]
x = "xx"
y = "yy + 0.4*xx^2"
z = "zz - 0.3*xx*yy"
[branch]
parameter = "p"
from = -0.2
to = 0.2
)case");
  const auto tori = coefficients(all, "neimark_sacker");
  REQUIRE(tori.size() == 1);
  CHECK_THAT(tori[0], WithinRel(2 * (-0.3 + 0.5 * 1.2), 1e-9));
  const auto folds = coefficients(
      traced_of(
          "[model]\nkind = \"map\"\n[model.parameters]\np = -1\n[model.equations]\nx = \"x + p + 0.8*x^2 "
          "+ x^3\"\n[model.start]\nx = 0.3\n[branch]\nparameter = \"p\"\nfrom = -0.1\nto = 1\n"),
      "fold");
  REQUIRE(folds.size() >= 1);
  CHECK_THAT(folds[0], WithinAbs(0.8, 1e-6));
}

TEST_CASE("Multipliers -1 that several are at once are told, without a coefficient", "[cycles]") {
  // Logistic maps, of which all are coupled: in phase -1 at r = 3, all others at r = 3 - n k.
  for (const int n : {2, 3, 4}) {
    std::string equations;
    std::string start;
    for (int i = 0; i < n; ++i) {
      const std::string x = "x" + std::to_string(i);
      equations += x + " = \"r*" + x + "*(1 - " + x + ") + 0.05*(0";
      for (int j = 0; j < n; ++j) equations += " + x" + std::to_string(j);
      equations += " - " + std::to_string(n) + "*" + x + ")\"\n";
      start += x + " = 0.333\n";
    }
    for (const char* max_step : {"0.2", "0.1", "0.02"}) {
      CAPTURE(n, max_step);
      const auto all = traced_of(
          "[model]\nkind = \"map\"\n[model.parameters]\nr = 1.5\n[model.equations]\n" + equations +
          "[model.start]\n" + start +
          "[branch]\nparameter = \"r\"\nfrom = 1.5\nto = 3.3\n[continuation]\nmax_step = " + max_step + "\n");
      const auto special = summarize(0, all[0])["special"];
      std::vector<std::pair<double, bool>> found;
      for (const auto& point : special) {
        if (point["type"] == "period_doubling") found.emplace_back(point["r"], point.contains("coefficient"));
      }
      REQUIRE(found.size() == 2);
      CHECK_THAT(found[0].first, WithinAbs(3 - 0.05 * n, 1e-10));
      CHECK(found[0].second == (n == 2));
      CHECK_THAT(found[1].first, WithinAbs(3, 1e-10));
      CHECK(found[1].second);
    }
  }
}

TEST_CASE("Two equal cycles whose periods double at once are told", "[cycles]") {
  const auto doubling = [](const std::string& equations) {
    const auto all = traced_of(
        "[model]\nkind = \"forced\"\nperiod = \"pi\"\n[model.parameters]\na = 0\n[model.equations]\n" +
        equations + "[cycles]\n[branch]\nparameter = \"a\"\nfrom = 0\nto = 0.6\n");
    const auto summary = summarize(0, all[0]);
    for (const auto& point : summary["special"]) {
      if (point["type"] == "period_doubling")
        return std::pair(point["a"].get<double>(), point.contains("coefficient"));
    }
    return std::pair(std::nan(""), false);
  };
  const std::string one = "x = \"y\"\ny = \"-0.1*y - (1 + a*cos(2*t))*x - x^3\"\n";
  const std::string other = "z = \"w\"\nw = \"-0.1*w - (1 + a*cos(2*t))*z - z^3\"\n";
  const auto alone = doubling(one);
  const auto both = doubling(one + other);
  CHECK(alone.second);
  CHECK_FALSE(both.second);
  CHECK_THAT(both.first, WithinAbs(alone.first, 1e-9));
}

TEST_CASE("Cycles that begin with two equal pairs at once are said not to be found", "[cycles]") {
  std::string equations;
  for (const char* i : {"0", "1", "2"}) {
    const std::string y = "y" + std::string(i);
    equations += "x" + std::string(i) + " = \"" + y + "\"\n" + y + " = \"(mu - x" + i + "^2)*" + y + " - x" +
                 i + " + 0.1*(y0 + y1 + y2 - 3*" + y + ")\"\n";
  }
  const auto all = traced_of("[model.parameters]\nmu = -1\n[model.equations]\n" + equations +
                             "[cycles]\n[branch]\nparameter = \"mu\"\nfrom = -1\nto = 1\nswitching = true\n");
  const auto summary = summarize(0, all[0]);
  std::vector<bool> simple;
  for (const auto& point : summary["special"]) {
    if (point["type"] == "hopf") simple.push_back(point.contains("lyapunov"));
  }
  CHECK(simple == std::vector<bool>{true, false});
  const auto warned = std::count_if(all.begin(), all.end(), [](const TracedBranch& one) {
    return one.branch.warning.find("several equal pairs") != std::string::npos;
  });
  CHECK(warned >= 1);
  for (const TracedBranch& one : all) CHECK((one.branch.points.size() > 1 || !one.branch.warning.empty()));
}

TEST_CASE("Special points of cycles without their multiplier are not resolved", "[cycles]") {
  const Complex minus(0, pi);  // ln -1
  const auto has = [](PointType type, Complex log) {
    return continuation::has_critical_multiplier(type, (ComplexVector(2) << -3, log).finished());
  };
  CHECK(has(PointType::fold, 0.05));
  CHECK_FALSE(has(PointType::fold, minus));
  CHECK_FALSE(has(PointType::fold, 80));
  CHECK(has(PointType::period_doubling, minus - 0.05));
  CHECK_FALSE(has(PointType::period_doubling, 0.05));
  CHECK(has(PointType::neimark_sacker, Complex(-0.05, 1)));
  CHECK_FALSE(has(PointType::neimark_sacker, Complex(0.2, 1)));
}

TEST_CASE("Meshes follow canards through their explosion", "[cycles]") {
  const auto all = traced_of(
      "[model.parameters]\nI = 1.5\nep = 0.001106\nb = 0.67\n[model.equations]\nv = \"v - v^3/3 - w + I\"\n"
      "w = \"ep*(v + 0.7 - b*w)\"\n[model.start]\nv = 0.7\nw = 2\n[cycles]\nintervals = 12\n[branch]\n"
      "parameter = \"I\"\nfrom = 1.5\nto = 2\nswitching = true\n[continuation]\nmax_points = 120\n");
  REQUIRE(all.size() == 2);
  CHECK(all[1].branch.stop == continuation::Stop::max_points);
  CHECK(value(all[1], all[1].branch.points.back(), "v_min") < -1);  // with its head
  CHECK(cycles(all[1])->intervals() < 400);
  for (const auto& point : summarize(0, all[1])["special"]) {
    if (point["type"] != "fold") continue;
    const double multiplier = point["multipliers"][0][0];
    const bool is_one = std::abs(std::log(std::abs(multiplier))) < 0.1;
    CHECK(point.value("resolved", true) == is_one);
    CHECK(point.contains("coefficient") == is_one);
  }
}
