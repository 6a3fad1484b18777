// The section [model] of case files: what works for models of the library works for formulas as well.

#include <fmt/format.h>

#include <cmath>

#include "arcslip/cases/runs.hpp"
#include "arcslip/cases/study_case.hpp"
#include "arcslip/continuation/curves/curve.hpp"
#include "catch.hpp"
#include "mistakes.hpp"
#include "places.hpp"
#include "scalar_problem.hpp"

using namespace arcslip;
using namespace arcslip::testing;

namespace {

using continuation::BranchPoint;
using continuation::PointType;

constexpr const char* brusselator = R"(
[model.parameters]
B = 1
A = 1
[model.equations]
x = "A - (B + 1)*x + x^2*y"
y = "B*x - x^2*y"
[model.start]
x = "A"
y = "B/A"
[branch]
parameter = "B"
from = 1
to = 4
)";

CasePlan plan_of(const std::string& text, const std::vector<std::string>& settings = {}) {
  return plan_case(CaseFile::of_text("case.toml", text, settings));
}

/// All branches of the case.
std::vector<TracedBranch> all_traced(const CasePlan& plan) {
  std::vector<TracedBranch> all;
  for (std::size_t i = 0; i < plan.count; ++i) {
    for (TracedBranch& one : trace(plan.branch(i))) all.push_back(std::move(one));
  }
  return all;
}

CasePlan plan_of_file(const std::string& name) {
  return plan_case(CaseFile(source_folder() + "/problems/" + name));
}

/// The points of a type on all branches.
std::vector<BranchPoint> found(const std::vector<TracedBranch>& all, PointType type) {
  std::vector<BranchPoint> points;
  for (const TracedBranch& one : all) {
    for (const BranchPoint& point : one.branch.points) {
      if (point.type == type) points.push_back(point);
    }
  }
  return points;
}

std::string error_in(const std::string& text, const std::vector<std::string>& settings = {}) {
  return error_of([&] { plan_of(text, settings); });
}

/// A guess from which plain corrections grow, with the solution.
struct Far {
  const char* name;
  const char* model;
  const char* parameter;
  double from;
  Vector solution;
};
const std::vector<Far> far_ones = {
    // -x^3 + 3 x + k x = lam of Koper's three variables
    Far{"koper", R"case(
[model.parameters]
lam = 12
[model.equations]
x = "10*(-10*y - x^3 + 3*x - lam)"
y = "x - 2*y + z"
z = "y - z"
[model.start]
x = 2
y = 1
z = 1
)case",
        "lam", 12, vector_of({-1.357171955, -1.357171955, -1.357171955})},
    // the stirred tank reactor of Uppal, Ray and Poore: 3 y = 14 x, where x = 0.06 (1 - x) exp(y)
    Far{"reactor", R"case(
[model.parameters]
Da = 0.06
[model.equations]
x = "-x + Da*(1 - x)*exp(y)"
y = "-3*y + 14*Da*(1 - x)*exp(y)"
[model.start]
x = 5
y = 12
)case",
        "Da", 0.06, vector_of({0.080255001, 0.374523338})},
    // the rest of Hodgkin and Huxley's nerve
    Far{"nerve", R"case(
[model.parameters]
I = 0
[model.equations]
V = "I - 120*m^3*h*(V - 115) - 36*n^4*(V + 12) - 0.3*(V - 10.6)"
m = "0.1*(25 - V)/(exp((25 - V)/10) - 1)*(1 - m) - 4*exp(-V/18)*m"
h = "0.07*exp(-V/20)*(1 - h) - h/(exp((30 - V)/10) + 1)"
n = "0.01*(10 - V)/(exp((10 - V)/10) - 1)*(1 - n) - 0.125*exp(-V/80)*n"
[model.start]
V = 60
m = 0.5
h = 0.5
n = 0.5
)case",
        "I", 0, vector_of({0.000277566265, 0.0529342176, 0.596111046, 0.317681168})},
    // Powell's badly scaled function, from where Moré, Garbow and Hillstrom 1981 have it begin
    Far{"powell", R"case(
[model]
kind = "algebraic"
[model.parameters]
a = 1.0001
[model.equations]
x = "1e4*x*y - 1"
y = "exp(-x) + exp(-y) - a"
[model.start]
y = 1
)case",
        "a", 1.0001, vector_of({1.098159e-5, 9.106146})},
    // whose first correction leads to where it has no value
    Far{"logarithm", R"case(
[model.parameters]
a = 0
[model.equations]
x = "log(x) - a"
[model.start]
x = 20
)case",
        "a", 0, vector_of({1})}};

}  // namespace

TEST_CASE("The Brusselator loses its stability at B = 1 + A^2") {
  const auto hopf = found(all_traced(plan_of_file("brusselator.toml")), PointType::hopf);
  REQUIRE(hopf.size() == 2);
  for (const BranchPoint& point : hopf) {
    const double A = point.parameters(0);
    CHECK_THAT(point.parameters(1), Catch::Matchers::WithinRel(1 + A * A, 1e-11));
    CHECK(std::abs(std::abs(point.eigenvalues(0).imag()) - A) < 1e-8);
  }
}

TEST_CASE("A special point where a branch starts is told once, and what leaves it is followed") {
  const auto from_zero = [](const std::string& kind, const std::string& equation, PointType type,
                            std::size_t branches) {
    const std::string text = "[model]\n" + kind + "parameters = { p = 0 }\nequations = { x = \"" + equation +
                             "\" }\n[branch]\nparameter = \"p\"\nswitching = true\n";
    for (const auto& range : {std::vector<std::string>{"branch.from=-1", "branch.start=0"},
                              std::vector<std::string>{"branch.from=0"}}) {
      std::vector<std::string> settings = range;
      settings.emplace_back("branch.to=1");
      const auto all = all_traced(plan_of(text, settings));
      CHECK(all.size() == branches);
      const auto told = found(all, type);
      REQUIRE(told.size() == 1);
      CHECK(std::abs(told[0].parameters(0)) < 1e-10);
      CHECK(std::abs(told[0].arclength) < 1e-10);
    }
  };
  from_zero("", "p*x - x^2", PointType::branch_point, 3);
  from_zero("", "p*x - x^3", PointType::branch_point, 3);
  from_zero("", "p - x^2", PointType::fold, 1);
  from_zero("kind = \"map\"\n", "-(1 + p)*x + x^2", PointType::period_doubling, 1);
}

TEST_CASE("A curve that starts where it ends is followed the other way") {
  const double sense = GENERATE(-1.0, 1.0);
  const auto all =
      all_traced(plan_of(R"(
[model]
parameters = { a = -1, b = 0 }
start = { x = -1 }
equations = { x = "y", y = "a + b*y + x^2 - x*y" }
[branch]
curve = "fold"
parameters = ["a", "b"]
window = [-1, 1]
switching = true
)",
                         {fmt::format("branch.from={}", -sense), fmt::format("branch.to={}", sense)}));
  REQUIRE(all.size() == 2);
  for (const TracedBranch& one : all) CHECK(found({one}, PointType::bogdanov_takens).size() == 1);
  double least = 0;  // of b at the Hopf points, a = -b^2, b < 0
  for (const BranchPoint& point : all[1].branch.points) least = std::min(least, point.parameters(0));
  CHECK_THAT(least, Catch::Matchers::WithinAbs(-1, 1e-9));
}

TEST_CASE("Cycles that leave the range with a Hopf point on its end are not begun") {
  const auto all = all_traced(plan_of(brusselator, {"branch.to=2", "branch.switching=true"}));
  REQUIRE(all.size() == 1);
  CHECK(found(all, PointType::hopf).size() == 1);
}

TEST_CASE("The map of Henon doubles its periods where they are known to") {
  const std::vector<TracedBranch> all = all_traced(plan_of_file("henon.toml"));
  REQUIRE(all.size() == 3);
  const auto born = found(all, PointType::branch_point);
  const auto doubled = found(all, PointType::period_doubling);
  REQUIRE(born.size() == 1);
  REQUIRE(doubled.size() == 2);
  CHECK_THAT(born[0].parameters(0), Catch::Matchers::WithinAbs(0.3675, 1e-9));
  for (const BranchPoint& point : doubled)
    CHECK_THAT(point.parameters(0), Catch::Matchers::WithinAbs(0.9125, 1e-10));
}

TEST_CASE("The neuron of Morris and Lecar fires between its two Hopf points") {
  const auto all = all_traced(plan_of_file("morris_lecar.toml"));
  const auto hopf = found(all, PointType::hopf);
  REQUIRE(hopf.size() == 2);
  CHECK_THAT(hopf[0].parameters(0), Catch::Matchers::WithinRel(93.8576183737254532, 1e-10));
  CHECK_THAT(hopf[1].parameters(0), Catch::Matchers::WithinRel(212.018816100374368, 1e-10));
  const auto greatest = found(all, PointType::trough);  // an inflow is negative
  REQUIRE(greatest.size() == 1);
  CHECK_THAT(greatest[0].parameters(0), Catch::Matchers::WithinRel(391.305883632857653, 1e-8));
}

TEST_CASE("Columns of formulas are in the order of the file") {
  const std::string text =
      std::string(brusselator) + "[model.observables]\nsum = \"x + y\"\nproduct = \"x*y\"\n";
  const std::vector<TracedBranch> all = all_traced(plan_of(text));
  CHECK(all[0].problem().parameter_names() == std::vector<std::string>{"B", "A"});
  CHECK(continuation::observable_names(all[0].problem()) ==
        std::vector<std::string>{"x", "y", "sum", "product"});
}

TEST_CASE("Parameters of formulas may be set, listed and continued") {
  const std::string text = std::string(brusselator) + "for_each = { A = [1, 2] }\n";
  CHECK(plan_of(text).count == 2);
  const auto listed = found(all_traced(plan_of(text)), PointType::hopf);
  REQUIRE(listed.size() == 1);  // that of A = 2 lies at B = 5
  const auto set = found(all_traced(plan_of(brusselator, {"model.parameters.A=0.5"})), PointType::hopf);
  REQUIRE(set.size() == 1);
  CHECK_THAT(set[0].parameters(0), Catch::Matchers::WithinRel(1.25, 1e-11));
  const auto more =
      plan_of(brusselator, {"model.parameters.a=3", "model.equations.x=\"a - x\"", "model.start.y=1"});
  CHECK(more.branch(0).problem.model->settings.back().name == "a");
}

TEST_CASE("Curves over two parameters are those of formulas") {
  const std::string text = replaced(brusselator, "parameter = \"B\"\nfrom = 1\nto = 4",
                                    "curve = \"hopf\"\nparameters = [\"B\", \"A\"]\nwindow = [1, 9]\n"
                                    "from = 0.5\nto = 2");
  const std::vector<TracedBranch> curves = all_traced(plan_of(text));
  REQUIRE(curves.size() == 1);
  REQUIRE(curves[0].branch.points.size() > 10);
  for (const BranchPoint& point : curves[0].branch.points) {
    const continuation::BasePoint at = curves[0].curve->split(point.unknowns, point.parameters, point.regime);
    CHECK_THAT(at.parameters(0), Catch::Matchers::WithinRel(1 + at.parameters(1) * at.parameters(1), 1e-9));
  }
}

TEST_CASE("Where a map doubles its period is a curve of branch points of twice the iterate") {
  const CasePlan plan = plan_of(R"toml(
[model]
kind = "map"
iterate = 2
[model.parameters]
a = 0
b = 0.3
[model.equations]
x = "1 - a*x^2 + y"
y = "b*x"
[model.start]
x = "1/(1 - b)"
y = "b/(1 - b)"
[branch]
curve = "branch_point"
parameters = ["a", "b"]
window = [0, 1.2]
from = 0.1
to = 0.5
)toml");
  const std::vector<TracedBranch> curves = all_traced(plan);
  REQUIRE(curves.size() == 1);
  for (const BranchPoint& point : curves[0].branch.points) {
    const continuation::BasePoint at = curves[0].curve->split(point.unknowns, point.parameters, point.regime);
    const double b = at.parameters(1);
    CHECK_THAT(at.parameters(0), Catch::Matchers::WithinAbs(0.75 * (1 - b) * (1 - b), 1e-9));
  }
}

TEST_CASE("All solutions of formulas are found by deflation") {
  const std::string text = R"(
[model]
kind = "algebraic"
[model.parameters]
c = 1
[model.equations]
x = "x^2 + y^2 - 2*c"
y = "x - y"
[branch]
parameter = "c"
from = 0.5
to = 2
start = 1
all_solutions = true
)";
  CHECK(all_traced(plan_of(text)).size() == 2);  // x = y = +-sqrt(c)
}

TEST_CASE("Mistakes in formulas are told on one line, with their place in the file") {
  const std::vector<Mistake> mistakes{
      {"x^2*y\"", "x^2*z\"", ":6:5: ", "model.equations.x: ", "there are x, y, B, A",
       R"(unknown name "z" at column 21 of "A - (B + 1)*x + x^2*z")"},
      {"B*x - x", "B*x -* x", ":7:5: ", "model.equations.y: ", "expected a number, a name or \"(\"",
       "column 6"},
      {"A = 1", "A = \"1\"", ":4:5: ", "model.parameters.A: ", "expected a finite number", "got \"1\""},
      {"A = 1", "x = 1", ":6:5: ", "model.equations.x: ", "model.parameters.x has this name already", ""},
      {"A = 1", "pi = 1", ":4:6: ", "model.parameters.pi: ", "pi is a constant", ""},
      {"A = 1", "\"a b\" = 1", ":4:9: ", "model.parameters.a b: ", "expected a name of letters", ""},
      {"y = \"B/A\"", "z = \"B/A\"", ":10:5: ", "model.start.z: ", "there is no equation of this name", ""},
      {"B*x - x^2*y\"", "B*x - x^2*t\"", ":7:5: ", "model.equations.y: ", "is the time",
       "\"t\" at column 11"},
      {"\"A\"", "true", ":9:5: ", "model.start.x: ", "a formula as a string, or a number", "got true"},
      {"[model.start]", "[model.starts]", ":8:1: ", "model.starts: ", "did you mean 'start'?", ""},
      {"[model.start]", "[system]\nmodel = \"ab\"\n[model.start]", ":8:1: ", "system: ", "not beside [model]",
       ""},
      {"[model.start]", "[geometry]\n[model.start]", ":8:1: ", "geometry: ", "only for systems with friction",
       ""},
      {"parameter = \"B\"", "parameter = \"C\"", ":12:13: ", "branch.parameter: ", "\"B\" or \"A\"",
       "got \"C\""},
      {"to = 4", "to = 4\nextrema_of = [\"z\"]", "", "branch.extrema_of", "names among \"x\", \"y\"",
       "\"z\""},
      {"to = 4", "to = 4\nfor_each = { B = [1, 2] }", "", "branch.for_each.B[0]",
       "has its values from [branch]", ""},
      {"[model.parameters]", "[model]\niterate = 2\n[model.parameters]",
       ":3:11: ", "model.iterate: ", "only of maps", ""},
      {"[model.parameters]", "[model]\nkind = \"flux\"\n[model.parameters]", ":3:8: ", "model.kind: ",
       "\"flow\" or \"forced\" or \"map\" or \"algebraic\" or \"boundary\"", "got \"flux\""}};
  for (const Mistake& mistake : mistakes)
    check_message(error_in(replaced(brusselator, mistake.from, mistake.to)), mistake);
  CHECK(error_in(brusselator, {"model.equations.x=\"A - q\""}) ==
        "--set: model.equations.x: unknown name \"q\" at column 5 of \"A - q\"; there are x, y, B, A");
  for (const std::string name : {"norm", "x_max", "y_min"}) {  // of columns of cycles
    const std::string named = replaced(brusselator, "A = 1", "A = 1\n" + name + " = 1");
    CHECK(error_in(named) == "no error");
    CHECK(error_in(replaced(named, "to = 4", "to = 4\nswitching = true")) ==
          fmt::format(
              "case.toml:5:{}: model.parameters.{}: results of cycles have {} already; expected another "
              "name",
              name.size() + 4, name, name));
  }
  CHECK(error_in("[model.parameters]\na = 1\n[branch]\n").find("model.equations: missing") !=
        std::string::npos);
  CHECK(error_in("[branch]\n").find("[system] or [model]") != std::string::npos);
  CHECK(error_of([&] {
          read_study(CaseFile::of_text("case.toml", replaced(brusselator, "[branch]", "[study]")));
        }).find("model: not of studies") != std::string::npos);
}

TEST_CASE("A guess that has no value is why a branch of formulas has no start") {
  const std::string text = replaced(brusselator, "\"B/A\"", "\"sqrt(-B)\"");
  const std::vector<TracedBranch> all = all_traced(plan_of(text));
  REQUIRE(all.size() == 1);
  CHECK(all[0].branch.stop == continuation::Stop::no_start);
  CHECK(all[0].branch.explanation.find("no value") != std::string::npos);
}

TEST_CASE("A branch begins from guesses from which Newton's method by itself runs away") {
  for (const Far& far : far_ones) {
    INFO(far.name);
    const std::vector<TracedBranch> all =
        all_traced(plan_of(far.model + fmt::format("[branch]\nparameter = \"{}\"\nfrom = {}\nto = {}\n",
                                                   far.parameter, far.from, far.from + 0.01)));
    REQUIRE(all.size() == 1);
    const continuation::Branch& branch = all[0].branch;
    REQUIRE(branch.stop == continuation::Stop::reached_end);
    CHECK((branch.points.front().unknowns - far.solution).cwiseAbs().maxCoeff() < 1e-6);
  }
}

TEST_CASE("Where there is no solution a far guess says so") {
  const auto [first, second] = GENERATE(std::pair("exp(x) + A", "-y"), std::pair("A + x^2 + y^2", "y - x"));
  const std::string text =
      replaced(replaced(brusselator, "A - (B + 1)*x + x^2*y", first), "B*x - x^2*y", second);
  const std::vector<TracedBranch> all = all_traced(plan_of(text, {"model.start.x=3"}));
  REQUIRE(all.size() == 1);
  CHECK(all[0].branch.stop == continuation::Stop::no_start);
  CHECK(all[0].branch.explanation ==
        "no solution was found from the guess at B = 1: Newton's method diverges");
}
