// Curves in two parameters of special points of cycles, and of equilibria, where they meet or end.

#include "cycle_cases.hpp"

namespace {

using namespace arcslip;
using namespace arcslip::testing;

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

TEST_CASE("Curves of folds and Hopf points are followed from where they meet", "[cycles]") {
  // Each of both case files comes to all curves of the other, and to those of cycles that begin on them;
  // numbers of BifurcationKit.jl, lorenz84.jl
  for (const char* file : {"lorenz84_fold_curve", "lorenz84_hopf_curve"}) {
    INFO(file);
    const Run run(file, {"branch.switching=true", "continuation.max_branches=6"});
    REQUIRE(run.traced.size() == 6);
    CHECK(run.traced.back().branch.explanation.find("max_branches") != std::string::npos);
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
  // of size 1e-3, or where rounding may move the fold by 1e-4 of b
  CHECK_THAT(value(folds[0], folds[0].branch.points.front(), "b"), WithinAbs(1.5e-6, 0.51e-6));
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
    REQUIRE(all.size() == 3);
    // Folds of cycles from a generalised Hopf point on, which come near to an orbit of infinite period,
    // sooner or later.
    CHECK_FALSE(all[2].branch.complete());
    CHECK_FALSE(all[2].branch.stop == Stop::infinite_period);
    CHECK(all[2].branch.points.size() < 500);
    for (const std::size_t i : {0, 1}) {
      const TracedBranch& one = all[i];
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
