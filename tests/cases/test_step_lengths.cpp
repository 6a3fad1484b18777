// What comes out of a case does not hang on the length of its steps, nor on how far it goes.

#include <set>

#include "case_runs.hpp"
#include "cycle_cases.hpp"
#include "small_structures.hpp"

namespace {

using namespace arcslip;
using namespace arcslip::testing;
using continuation::Branch;

std::string with_steps(double longest) { return fmt::format("[continuation]\nmax_step = {}\n", longest); }

/// That a branch without symmetry passes the pitchfork at which it gains it, on to its mirror image.
void check_passes(const std::string& system, std::initializer_list<double> steps,
                  const std::string& parameter, double pitchfork, double accuracy) {
  for (const double step : steps) {
    INFO(step);
    const auto all = traced_of(system + with_steps(step));
    REQUIRE(!all.empty());
    INFO(all[0].branch.explanation);
    check_values(values_at(all[0], PointType::branch_point, parameter), {pitchfork}, accuracy);
    CHECK(values_at(all[0], PointType::fold, parameter).empty());
    CHECK(all[0].branch.stop == Stop::left_range);
  }
}

}  // namespace

TEST_CASE("Each end of a canard explosion has its fold", "[cycles]") {
  for (const double step : {0.01, 0.1, 0.3}) {
    INFO(step);
    const auto all = traced_of(R"case([model.parameters]
I = 0
[model.equations]
v = "v - v^3/3 - w + I"
w = "0.08*(v + 0.7 - 0.8*w)"
[model.start]
v = -1.2
w = -0.6
[branch]
parameter = "I"
from = 0
to = 2
switching = true
)case" + with_steps(step));
    REQUIRE(all.size() == 2);
    // by multiple shooting in 60 parts to 1e-13, and its image about I = 0.875
    check_values(values_at(all[1], PointType::fold, "I"), {0.3241785225037, 1.4258214774963}, 1e-8);
  }
}

TEST_CASE("A pitchfork of cycles sheds its branch wherever steps end", "[cycles]") {
  for (const double step : {0.03, 0.0908, 0.1}) {
    INFO(step);
    const auto all = traced_of(R"case([model]
kind = "forced"
period = "2*pi/W"
[model.parameters]
g = 0.2
W = 0.6666666666666666
[model.equations]
th = "v"
v = "-v/2 - sin(th) + g*cos(W*t)"
[branch]
parameter = "g"
from = 0.2
to = 1.2
switching = true
[cycles]
doublings = 0
)case" + with_steps(step));
    REQUIRE(all.size() >= 2);
    check_values(values_at(all[0], PointType::branch_point, "g"), {1.00431948}, 1e-7);
    const std::vector<double> doublings = values_at(all[1], PointType::period_doubling, "g");
    REQUIRE(!doublings.empty());
    CHECK_THAT(doublings[0], WithinAbs(1.06637286, 1e-7));  // by shooting to 1e-12
  }
}

TEST_CASE("A start that leads to a solution is kept, whatever lies about it", "[boundary]") {
  for (const double step : {0.01, 0.1, 0.3}) {
    for (const double to : {6, 10}) {
      const auto all = traced_of(
          R"case([model]
kind = "boundary"
interval = { x = [0, 1] }
parameters = { n = 0.5 }
equations = { y = "z", z = "n*sinh(n*y)" }
conditions = ["y_left", "y_right - 1"]
[model.start]
y = "x"
z = 1
[branch]
parameter = "n"
from = 0.5
)case" + fmt::format("to = {}\n", to) +
          with_steps(step));
      REQUIRE(all.size() == 1);
      CHECK(all[0].branch.complete());
      CHECK_THAT(values_at(all[0], PointType::start, "z_left").at(0), WithinRel(0.9590437954132, 1e-6));
    }
  }
}

TEST_CASE("Points of period two pass to their images where they meet", "[maps]") {
  // x = r x (1 - x): r = 3; the map of Henon: a = 3 (1 - b)^2/4
  check_passes(R"case([model]
kind = "map"
iterate = 2
[model.parameters]
r = 3.4
[model.equations]
x = "r*x*(1 - x)"
[model.start]
x = 0.842
[branch]
parameter = "r"
from = 3.4
to = 2.5
)case",
               {0.005, 0.007, 0.00787, 0.05, 0.2}, "r", 3, 1e-10);
  check_passes(R"case([model]
kind = "map"
iterate = 2
[model.parameters]
a = 0.8
b = 0.3
[model.equations]
x = "1 - a*x^2 + y"
y = "b*x"
[model.start]
x = 1.2
y = -0.1
[branch]
parameter = "a"
from = 0.8
to = 0.1
)case",
               {0.005, 0.0056, 0.00787, 0.01387, 0.1}, "a", 0.3675, 1e-10);
}

TEST_CASE("Cycles pass to their images where they gain a symmetry", "[cycles]") {
  check_passes(R"case([model]
kind = "forced"
period = "2*pi/W"
[model.parameters]
F = 2.0
d = 0.3
W = 2.0
[model.equations]
x = "v"
v = "F*cos(W*t) - d*v + x - x^3"
[model.start]
x = 1.0
[cycles]
settle = 800
[branch]
parameter = "F"
from = 0.1
to = 6
start = 0.3
)case",
               {0.02, 0.05, 0.1, 0.264}, "F", 3.661299205, 1e-7);
  check_passes(R"case([model]
kind = "piecewise"
period = "2*pi/w"
[model.parameters]
w = 1.72
r = 0.7
zeta = 0.02
gap = 0.4
[model.equations]
x = "v"
v = "cos(w*t) - 2*zeta*v - x"
[model.start]
v = 1.0
[model.pieces.up]
until = "x - gap"
reset = { v = "-r*v" }
[model.pieces.down]
until = "x + gap"
reset = { v = "-r*v" }
[cycles]
settle = 400
[branch]
parameter = "w"
from = 1.7
to = 1.8
start = 1.72
)case",
               {0.005, 0.03633, 0.1, 0.264}, "w", 1.73739334, 1e-8);
}

TEST_CASE("A bubble of cycles closes where its orbits become symmetric", "[cycles]") {
  for (const double step : {0.005, 0.02, 0.0667, 0.2, 0.3}) {
    INFO(step);
    const auto all = traced_of(R"case([model]
kind = "forced"
period = "2*pi"
[model.parameters]
F = 0.5
d = 0.4
[model.equations]
x = "v"
v = "F*cos(t) - d*v - x^3"
[branch]
parameter = "F"
from = 0.1
to = 12
switching = true
[cycles]
settle = 400
doublings = 0
)case" + with_steps(step));
    REQUIRE(all.size() == 2);
    CHECK(all[1].branch.stop == Stop::closed_loop);
    // where the half-period map has the multiplier -1, by DOP853 to 1e-13
    check_values(values_at(all[0], PointType::branch_point, "F"), {2.92134106, 11.91784506}, 1e-7);
    check_values(values_at(all[1], PointType::branch_point, "F"), {11.91784506}, 1e-7);
    check_values(values_at(all[1], PointType::period_doubling, "F"),
                 {7.9898554, 10.2117192, 10.2117192, 7.9898554}, 1e-6);
    CHECK(values_at(all[1], PointType::fold, "F").empty());
  }
}

TEST_CASE("Cycles at which two others leave at once are branch points", "[cycles]") {
  for (const double step : {0.02, 0.1, 0.3}) {
    INFO(step);
    const auto all = traced_of(R"case([model]
kind = "forced"
period = "2*pi"
[model.parameters]
mu = -0.5
[model.equations]
x = "-x + cos(t)"
p = "mu*p - p^3 - 3*p*q^2"
q = "mu*q - q^3 - 3*q*p^2"
[branch]
parameter = "mu"
from = -0.5
to = 0.5
[cycles]
settle = 100
)case" + with_steps(step));
    REQUIRE(all.size() == 1);
    check_values(values_at(all[0], PointType::branch_point, "mu"), {0}, 1e-9);
  }
}

TEST_CASE("A branch ends once at the edge of what has a value", "[model]") {
  for (const double step : {0.03, 0.1}) {
    INFO(step);
    const auto all = traced_of(R"case([model.parameters]
mu = 0
[model.equations]
x = "sqrt(0.3 - mu) - x"
[model.start]
x = 0.5
[branch]
parameter = "mu"
from = 0
to = 1
)case" + with_steps(step));
    REQUIRE(all.size() == 1);
    const Branch& branch = all[0].branch;
    CHECK(!branch.complete());
    CHECK(branch.points.size() < 100);
    CHECK_THAT(branch.points.back().parameters(0), WithinAbs(0.3, 1e-12));
  }
}

TEST_CASE("Further slips of two contacts, forwards and backwards at once, are told once each", "[slips]") {
  SmallStructure alike;  // a peak on the corner where they begin
  alike.mass = Matrix::Identity(2, 2);
  alike.stiffness = (Matrix(2, 2) << 2, -0.5, -0.5, 2).finished();
  alike.damping = 0.02 * alike.stiffness;
  alike.load = ComplexVector::Ones(2);
  alike.contact_stiffness = {1, 1};
  alike.preload = 0.3;
  const TemporaryFolder folder;
  write_matrices(alike, folder);
  std::string text = small_system_text(alike, "5");
  text.insert(text.find("harmonics"), "even_harmonics = true\npath = \"full\"\n");
  text += "[branch]\nparameter = \"eta\"\nfrom = 0.06\nto = 0.08\n";
  for (const double step : {0.01, 0.02, 0.05, 0.1, 0.2, 0.4}) {
    CAPTURE(step);
    const Case input = read_case(folder.write("case.toml", text + with_steps(step)));
    const auto traced = trace(input.branches.front());
    REQUIRE(traced.size() == 1);
    CHECK(traced[0].branch.complete());
    CHECK(points(traced[0], PointType::peak).size() == 1);
    CHECK(points(traced[0], PointType::trough).empty());
    std::set<std::string> slips;
    for (const BranchPoint& point : points(traced[0], PointType::event)) slips.emplace(point.type_name());
    CHECK(points(traced[0], PointType::event).size() == 4);
    CHECK(slips.size() == 4);
  }
}

TEST_CASE("Further slips that end soon after the motion turns back are told in whatever steps", "[slips]") {
  for (const double step : {0.01, 0.02, 0.05, 0.1, 0.3}) {
    CAPTURE(step);
    const Run run("nlvib_elements",
                  {fmt::format("continuation.max_step={}", step), "branch.from=0.174", "branch.to=0.178"});
    std::map<std::string, int> count;
    for (const BranchPoint& point : points(run.traced[0], PointType::event))
      ++count[std::string(point.type_name())];
    CHECK(count["further_slip_forwards"] == 2);
    CHECK(count["further_slip_backwards"] == 2);
  }
}

TEST_CASE("Conditions on folds that no longer fit are no branch points", "[cycles]") {
  // Where borders are at right angles to null vectors the determinant has a pole. At the place of the default
  // step the Jacobian of {f, f_u q, q^T q - 1} has no singular value below 0.1.
  for (const double step : {0.2, 0.1, 0.05, 0.02}) {
    INFO(step);
    const auto all = traced_of(R"case([model]
parameters = { a = 0, b = 0 }
[model.equations]
x = "-0.615*x+0.457*y+0.062*z+0.223*a+0.778*a*x-1.293*a*y+1.012*a*z-1.435*b-0.113*b*x+0.427*b*z+0.168*x*y-0.509*x*z+0.222*y*y+0.011*y*z-0.404*z*z-0.183*x^3"
y = "0.812*x-0.631*y-0.487*z+1.154*a+0.407*a*y+1.455*a*z-0.385*b-2.652*b*x-1.544*b*y-0.179*b*z+0.555*x*z+0.277*y*y+0.224*y*z-1.216*z*z-0.005*y^3-0.101*x*x*x-0.276*x*y*z-0.021*y*y*z-0.182*z*z*z"
z = "0.380*x-0.242*y-0.029*z+1.220*a-1.379*a*x+0.433*a*y+0.011*b+0.174*x*x-0.081*x*z+0.399*y*z-0.227*z^3-0.127*x*x*z-0.037*x*z*z-0.002*z*z*z"
[branch]
curve = "fold"
parameters = ["a", "b"]
window = [-1, 1]
from = -1
to = 1
)case" + with_steps(step));
    REQUIRE(all.size() == 2);
    CHECK(all_values_at(all, PointType::branch_point, "a").empty());
    CHECK(all_values_at(all, PointType::cusp, "a").size() == 2);
  }
}
