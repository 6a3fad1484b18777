// Cycles where several things meet, and what is refused.

#include "cycle_cases.hpp"

namespace {

using namespace arcslip;
using namespace arcslip::testing;

/// x' = g x - turn y, y' = turn x + g y: cycles are the circles on which g(x^2 + y^2, mu) vanishes.
std::string circles(const std::string& g, const std::string& turn, const std::string& rest) {
  return "[model.parameters]\nmu = 0\n[model.definitions]\ns = \"x^2 + y^2\"\ng = \"" + g + "\"\nturn = \"" +
         turn + "\"\n[model.equations]\nx = \"g*x - turn*y\"\ny = \"turn*x + g*y\"\n" + rest;
}

/// The one curve along which `second` is what it is at `first`, without special points on its way, and which
/// ends before cycles are gone, at first = 0.
template <class Exact>
void check_ends_at_rest(const std::vector<TracedBranch>& all, const std::string& first,
                        const std::string& second, const Exact& exact, double margin) {
  REQUIRE(all.size() == 1);
  for (const BranchPoint& point : all[0].branch.points) {
    const double at = value(all[0], point, first);
    CHECK_THAT(value(all[0], point, second), WithinAbs(exact(at), margin));
    CHECK(at > 1e-7);
    CHECK(
        (point.type == PointType::regular || point.type == PointType::start || point.type == PointType::end));
  }
}

}  // namespace

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
  const auto all = Run("roessler_cascade", {"branch.from=3.2", "branch.to=2.5"}).traced;
  REQUIRE(all.size() == 1);
  CHECK(all[0].branch.stop == Stop::left_regime);
  CHECK_THAT(all[0].branch.explanation, ContainsSubstring("two rounds of one of half the period"));
  CHECK_THAT(value(all[0], all[0].branch.points.back(), "c"), WithinAbs(2.832445, 2e-6));
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

TEST_CASE("Curves of folds and Hopf points are followed from where they meet", "[cycles]") {
  // Each of both case files comes to all curves of the other; numbers of BifurcationKit.jl, lorenz84.jl
  for (const char* file : {"lorenz84_fold_curve", "lorenz84_hopf_curve"}) {
    INFO(file);
    const Run run(file, {"branch.switching=true"});
    REQUIRE(run.traced.size() == 3);
    const auto at = [&](PointType type) { return all_values_at(run.traced, type, "F"); };
    check_values(at(PointType::generalized_hopf), {2.37636009}, 1e-8);
    CHECK(at(PointType::hopf_hopf).size() == 2);
    for (const double F : at(PointType::hopf_hopf)) CHECK_THAT(F, WithinAbs(2.53322111, 1e-8));
    for (const double F : at(PointType::zero_hopf)) CHECK_THAT(F, WithinAbs(1.283419296, 1e-8));
    for (const double F : at(PointType::bogdanov_takens)) CHECK_THAT(F, WithinAbs(1.446716701, 1e-8));
    for (const TracedBranch& one : run.traced) CHECK(one.branch.points.size() > 5);
  }
}

TEST_CASE("Curves of cycles end where these have shrunk onto equilibria", "[cycles]") {
  // Folds at mu = -b^2/4, of s = b/2, up to the generalised Hopf point b = 0.
  const auto folds = traced_of(circles("mu + b*s - s^2", "1 + mu",
                                       "[model.start]\nx = 0\n[branch]\ncurve = \"cycle_fold\"\nparameters = "
                                       "[\"mu\", \"b\"]\nwindow = [-0.5, 0.5]\nfrom = -0.5\nto = 2\n"),
                               {"model.parameters.b=1", "model.parameters.mu=-0.5"});
  check_ends_at_rest(
      folds, "b", "mu", [](double b) { return -b * b / 4; }, 1e-9);
  CHECK_THAT(value(folds[0], folds[0].branch.points.front(), "b"), WithinAbs(1e-6, 1e-8));
  // A third unknown grows at the mean rate nu + s beside the circles s = mu.
  const auto meetings = traced_of(R"case(
[model.parameters]
mu = 0.5
nu = -1
[model.definitions]
s = "x^2 + y^2"
[model.equations]
x = "(mu - s)*x - y"
y = "x + (mu - s)*y"
z = "z*(nu + s + 0.3*x - z)"
[model.start]
x = 0.7
[cycles]
settle = 100
[branch]
curve = "branch_point"
parameters = ["nu", "mu"]
window = [-1, 0.5]
from = -0.5
to = 2
)case");
  check_ends_at_rest(
      meetings, "mu", "nu", [](double mu) { return -mu; }, 1e-8);
}

TEST_CASE("Curves of folds end at generalised Hopf points, aside from zero, on any mesh", "[cycles]") {
  const std::string oscillator = R"case(
[model.parameters]
p1 = 0.5
p2 = 4
p3 = 0.5
p4 = 2
[model.equations]
x = "(-p4*(x^3/3 - x) + (z - x)/p2 - y)/p1"
y = "x - p3"
z = "-(z - x)/p2"
[model.start]
x = "p3"
y = "-p4*(p3^3/3 - p3)"
z = "p3"
[branch]
curve = "cycle_fold"
parameters = ["p3", "p2"]
window = [0.85, 0.95]
from = 1
to = 4.5
)case";
  for (const std::string tolerance : {"1e-4", "1e-6", "1e-8"}) {
    const auto all = traced_of(oscillator, {"cycles.tolerance=" + tolerance});
    REQUIRE(all.size() == 2);
    const continuation::Branch& ended = all[0].branch;
    CHECK(ended.first_stop == Stop::left_regime);
    CHECK(ended.complete());
    CHECK(ended.points.size() < 100);
    CHECK_THAT(value(all[0], ended.points.front(), "p2"), WithinAbs(1.530963, 5e-5));
    CHECK_THAT(value(all[0], ended.points.front(), "p3"), WithinAbs(0.867048, 5e-6));
    for (const BranchPoint& point : ended.points)
      CHECK((point.type == PointType::regular || point.type == PointType::start ||
             point.type == PointType::end));
  }
}

TEST_CASE("Curves of tori's births end on double Hopf points", "[cycles]") {
  const auto births = traced_of(R"case(
[model.parameters]
mu = 0.5
nu = 0.2
[model.definitions]
s = "x^2 + y^2"
q = "z^2 + w^2"
[model.equations]
x = "(mu - s - 1.5*q)*x - y"
y = "x + (mu - s - 1.5*q)*y"
z = "(nu - q - 2*s)*z - sqrt(2)*w"
w = "sqrt(2)*z + (nu - q - 2*s)*w"
[model.start]
x = 0.7
[cycles]
settle = 100
[branch]
curve = "neimark_sacker"
parameters = ["nu", "mu"]
window = [-0.5, 1.5]
from = -0.5
to = 1
)case");
  check_ends_at_rest(
      births, "mu", "nu", [](double mu) { return 2 * mu; }, 1e-8);
  CHECK_THAT(value(births[0], births[0].branch.points.front(), "mu"), WithinAbs(5e-7, 1e-9));
}

TEST_CASE("Cycles with a last predator leave those without it where AUTO-07p has it", "[cycles]") {
  const Run chain("food_chain_cycles");
  REQUIRE(chain.traced.size() == 2);
  const auto meetings = values_at(chain.traced[0], PointType::branch_point, "d2");
  REQUIRE(meetings.size() == 1);
  CHECK_THAT(meetings[0], WithinAbs(0.0155004, 1e-7));
  const TracedBranch& coexisting = chain.traced[1];
  check_values(values_at(coexisting, PointType::start, "d2"), meetings, 1e-12);
  check_values(values_at(coexisting, PointType::fold, "d2"), {0.0148013214}, 1e-8);
  // Both ends are Hopf points: of l^3 + a l^2 + b l + c, where a b = c.
  for (const BranchPoint& end : {coexisting.branch.points.front(), coexisting.branch.points.back()}) {
    const double d2 = value(coexisting, end, "d2");
    const double prey = d2 / (0.1 - 2 * d2);
    const double root = std::sqrt(4 - 12 * (5 * prey - 1)) / 6;
    const double food = 1 / 3.0 + (value(coexisting, end, "x_max") > -1.2 ? root : -root);
    const double z = (1 + 2 * prey) / 0.1 * (5 * food / (1 + 3 * food) - 0.75);
    CHECK_THAT(0.5 * (value(coexisting, end, "z_max") + value(coexisting, end, "z_min")), WithinAbs(z, 1e-4));
    const double by_food = 1 + 3 * food;
    const double by_prey = 1 + 2 * prey;
    const double xx = -food + 15 * food * prey / (by_food * by_food);
    const double xy = -5 * prey / by_food;
    const double yx = 5 * food / (by_food * by_food);
    const double yy = 0.2 * z * prey / (by_prey * by_prey);
    const double yz = -0.1 / by_prey;
    const double zy = z * 0.1 * prey / (by_prey * by_prey);
    const double a = -xx - yy;
    const double b = xx * yy - xy * yx - yz * zy;
    CHECK_THAT(a * b, WithinRel(xx * yz * zy, 5e-3));
  }
}

TEST_CASE(
    "A curve of Hopf points is followed from one Bogdanov-Takens point of a curve of folds to the next") {
  const std::string reactor = R"case(
[model.parameters]
p3 = 500
p4 = 210
[model.definitions]
R = "y/(3.4 + y)*x/(1 + x + 0.023*x^2)"
[model.equations]
x = "-3*(p4*R - (145 - x))"
y = "-3*(p4*R - 0.2*(p3 - y))"
[model.start]
x = 62.7662
y = 88.8308
[branch]
curve = "fold"
parameters = ["p3", "p4"]
window = [500, 800]
from = 50
to = 400
switching = true
)case";
  for (const std::string step : {"0.03", "0.1", "0.3"}) {
    const auto all = traced_of(reactor, {"continuation.max_step=" + step});
    REQUIRE(all.size() == 2);
    for (const TracedBranch& one : all) {
      const std::vector<BranchPoint> ends = points(one, PointType::bogdanov_takens);
      REQUIRE(ends.size() == 2);
      CHECK_THAT(value(one, ends[0], "p3"), WithinRel(617.276106, 1e-8));
      CHECK_THAT(value(one, ends[1], "p3"), WithinRel(771.052613, 1e-8));
    }
    CHECK(all[1].branch.points.front().type == PointType::bogdanov_takens);
    CHECK(all[1].branch.points.back().type == PointType::bogdanov_takens);
    const std::vector<BranchPoint> turns = points(all[1], PointType::fold);
    REQUIRE(turns.size() == 1);
    CHECK_THAT(value(all[1], turns[0], "p4"), WithinRel(216.362307, 1e-8));
  }
}

TEST_CASE("From a Bogdanov-Takens point that a symmetry keeps leads a curve of branch points") {
  // x = y = z = 0 is singular where be + nu = 0, and has a double eigenvalue 0 there where be^2 = r.
  const std::string circuit = R"case(
[model.parameters]
nu = -0.721309
be = 0.6
r = 0.6
a3 = 0.328578
b3 = 0.933578
[model.equations]
x = "(-(be + nu)*x + be*y - a3*x^3 + b3*(y - x)^3)/r"
y = "be*x - be*y - z - b3*(y - x)^3"
z = "y"
[model.start]
x = 0.2
z = 0.15
[branch]
curve = "hopf"
parameters = ["nu", "be"]
window = [-0.62, -1.4]
from = 0.2
to = 1.5
switching = true
)case";
  for (const std::string step : {"0.03", "0.1", "0.3"}) {
    const auto all = traced_of(circuit, {"continuation.max_step=" + step});
    REQUIRE(all.size() == 2);
    const std::vector<BranchPoint> meeting = points(all[0], PointType::bogdanov_takens);
    REQUIRE(meeting.size() == 1);
    CHECK_THAT(value(all[0], meeting[0], "be"), WithinRel(std::sqrt(0.6), 1e-9));
    CHECK_THAT(value(all[1], all[1].branch.points.front(), "nu"), WithinAbs(-0.62, 1e-9));
    CHECK_THAT(value(all[1], all[1].branch.points.back(), "nu"), WithinAbs(-1.4, 1e-9));
    for (const BranchPoint& point : all[1].branch.points) {
      CHECK_THAT(value(all[1], point, "be"), WithinAbs(-value(all[1], point, "nu"), 1e-9));
      CHECK((point.type == PointType::regular || point.type == PointType::start ||
             point.type == PointType::end));
    }
  }
}
