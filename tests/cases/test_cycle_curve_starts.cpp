// Curves in two parameters of special points of cycles: from where small cycles have them, and on meshes that
// follow them.

#include "arcslip/continuation/curves/curve.hpp"
#include "arcslip/continuation/cycles/doubling_problem.hpp"
#include "arcslip/continuation/cycles/torus_problem.hpp"
#include "cycle_cases.hpp"

namespace {

using namespace arcslip;
using namespace arcslip::testing;

/// What is a curve of special cycles among those that were traced.
std::vector<TracedBranch> of_cycles(std::vector<TracedBranch> all) {
  std::erase_if(all, [](const TracedBranch& one) {
    return one.curve == nullptr || dynamic_cast<const CycleProblem*>(&one.curve->base()) == nullptr;
  });
  return all;
}

/// The Hopf points over two parameters and what begins on them.
std::vector<TracedBranch> with_hopf_points(const std::string& equations, const std::string& parameters,
                                           const std::string& range) {
  return traced_of("[model.parameters]\n" + parameters + "[model.equations]\n" + equations +
                   "[branch]\ncurve = \"hopf\"\nswitching = true\n" + range);
}

/// The latter alone.
std::vector<TracedBranch> from_hopf_points(const std::string& equations, const std::string& parameters,
                                           const std::string& range) {
  return of_cycles(with_hopf_points(equations, parameters, range));
}

/// r_1' = (m - r_1^2 - r_2^2/2) r_1, r_2' = (k - 1.5 r_1^2 - r_2^2) r_2, which turn at these rates.
std::string double_hopf(const std::string& first, const std::string& second) {
  const std::string g = "(m - x^2 - y^2 - (z^2 + w^2)/2)";
  const std::string h = "(k - 1.5*(x^2 + y^2) - z^2 - w^2)";
  return fmt::format(
      "x = \"{0}*x - {2}*y\"\ny = \"{2}*x + {0}*y\"\nz = \"{1}*z - {3}*w\"\nw = \"{3}*z + {1}*w\"\n", g, h,
      first, second);
}

/// Whether a point of a curve is where an exact one has it.
template <class Exact>
void check_curve(const TracedBranch& curve, const std::string& name, const Exact& exact, double margin) {
  CHECK(curve.branch.complete());
  for (const BranchPoint& point : curve.branch.points)
    CHECK_THAT(value(curve, point, name), WithinAbs(exact(point), margin));
}

using Names = std::vector<std::string>;

Names kinds(const std::vector<TracedBranch>& all) {
  Names names;
  for (const TracedBranch& one : all) {
    const auto* curve = one.curve.get();
    names.push_back(dynamic_cast<const continuation::DoublingProblem*>(curve) != nullptr ? "doublings"
                    : dynamic_cast<const continuation::TorusProblem*>(curve) != nullptr  ? "tori"
                                                                                         : "folds");
  }
  return names;
}

/// H. R. Wilson, J. D. Cowan, Biophys. J. 12 (1972) 1: with (p, q, x, y) so is (-p, -8 - q, 1 - x, 1 - y).
std::vector<TracedBranch> of_two_populations() {
  return traced_of(R"case([model.parameters]
p = -2
q = -6
a = 10
b = 10
c = 10
d = -2
[model.equations]
x = "-x + 1/(1+exp(-(p + a*x - b*y)))"
y = "-y + 1/(1+exp(-(q + c*x + d*y)))"
[branch]
curve = "hopf"
parameters = ["p", "q"]
window = [-6, 6]
from = -12
to = 4
switching = true
)case");
}

}  // namespace

TEST_CASE("Folds of cycles are followed from generalised Hopf points", "[cycles]") {
  // r' = (mu + b s - s^2) r, s = r^2, in any units of r: folds at s = b/2, mu = -b^2/4
  for (const double unit : {1e-3, 1.0, 1e3}) {
    INFO(unit);
    const std::string s = fmt::format("((x^2 + y^2)/{})", unit * unit);
    const auto curves = from_hopf_points(
        fmt::format("x = \"(mu + b*{0} - {0}^2)*x - y\"\ny = \"x + (mu + b*{0} - {0}^2)*y\"\n"
                    "[model.scale]\nx = {1}\ny = {1}\n",
                    s, unit),
        "mu = 0\nb = 1\n", "parameters = [\"mu\", \"b\"]\nwindow = [-1, 1]\nfrom = -2\nto = 2\n");
    REQUIRE(curves.size() == 1);
    const TracedBranch& folds = curves[0];
    check_curve(
        folds, "mu", [&](const BranchPoint& at) { return -std::pow(value(folds, at, "b"), 2) / 4; }, 1e-9);
    CHECK(value(folds, folds.branch.points.front(), "b") < 1e-3);
    CHECK(value(folds, folds.branch.points.back(), "b") == 2);
    CHECK_THAT(value(folds, folds.branch.points.back(), "x_max"), WithinRel(unit, 1e-8));
  }
}

TEST_CASE("Neimark-Sacker points are followed from double Hopf points", "[cycles]") {
  // those of the first cycle at k = 1.5 m, of the second at m = k/2
  const auto curves = from_hopf_points(double_hopf("1", "sqrt(2)"), "m = 0\nk = 0.5\n",
                                       "parameters = [\"m\", \"k\"]\nwindow = [-1, 1]\nfrom = -1\nto = 1\n");
  REQUIRE(curves.size() == 2);
  for (const TracedBranch& tori : curves) {
    const bool is_first = value(tori, tori.branch.points.back(), "x_max") > 0.1;
    const double ratio = is_first ? 1.5 : 2;
    const double turns = is_first ? std::sqrt(2.0) : std::sqrt(0.5);
    check_curve(
        tori, "k", [&](const BranchPoint& at) { return ratio * value(tori, at, "m"); }, 1e-9);
    check_curve(
        tori, "angle", [&](const BranchPoint&) { return std::acos(std::cos(two_pi * turns)); }, 1e-7);
    CHECK(value(tori, tori.branch.points.front(), "m") < 1e-5);
    CHECK(std::max(value(tori, tori.branch.points.back(), "m"),
                   value(tori, tori.branch.points.back(), "k")) == 1);
  }
}

TEST_CASE("Neimark-Sacker points are followed from zero-Hopf points that have them", "[cycles]") {
  const auto curves_of = [](const std::string& sign) {
    const std::string g = "(k - 0.3*m + x + x^2)";
    return from_hopf_points("x = \"m + x^2 " + sign + " (y^2 + z^2)\"\ny = \"" + g + "*y - z\"\nz = \"y + " +
                                g + "*z\"\n[model.start]\nx = -0.5\n",
                            "m = -0.25\nk = 0\n",
                            "parameters = [\"k\", \"m\"]\nwindow = [-1, 1]\nfrom = -0.5\nto = 0.1\n");
  };
  // cycles of r^2 = m at x = 0, k = 0.3 m, around which x and r turn by 2 pi sqrt(2 m) in each round
  const auto curves = curves_of("-");
  REQUIRE(curves.size() == 2);  // at k = 0.25 of m = -0.25 the Hopf point is a generalised one
  const TracedBranch& tori = curves[1];
  check_curve(
      tori, "k", [&](const BranchPoint& at) { return 0.3 * value(tori, at, "m"); }, 1e-9);
  check_curve(
      tori, "angle", [&](const BranchPoint& at) { return two_pi * std::sqrt(2 * value(tori, at, "m")); },
      1e-5);
  check_values(values_at(tori, PointType::resonance_1_4, "m"), {1.0 / 32}, 1e-9);
  check_values(values_at(tori, PointType::resonance_1_3, "m"), {1.0 / 18}, 1e-9);
  CHECK(value(tori, tori.branch.points.back(), "m") == 0.1);
  for (const TracedBranch& other : curves_of("+"))
    CHECK(dynamic_cast<const continuation::TorusProblem*>(other.curve.get()) == nullptr);
}

TEST_CASE("Curves are followed on which the second parameter stands still", "[cycles]") {
  // pairs on the axis at m = 0 and at k = 0
  const auto curves =
      with_hopf_points(double_hopf("2.7", "1"), "m = -0.5\nk = -0.2\n",
                       "parameters = [\"m\", \"k\"]\nwindow = [-0.5, 0.4]\nfrom = -0.3\nto = 0.3\n");
  REQUIRE(curves.size() == 4);
  const TracedBranch& other = curves[1];
  CHECK(other.branch.complete());
  check_values(
      {value(other, other.branch.points.front(), "m"), value(other, other.branch.points.back(), "m")},
      {-0.5, 0.4}, 0);
  CHECK(values_at(other, PointType::hopf_hopf, "m").size() == 1);
  CHECK(values_at(other, PointType::fold, "m").empty());
  for (const BranchPoint& point : other.branch.points)
    CHECK_THAT(value(other, point, "k"), WithinAbs(0, 1e-12));
  // cycles of r^2 = m at x = 0, k = 0
  const auto tori = from_hopf_points(
      "x = \"m + x^2 - y^2 - z^2\"\ny = \"(k + x + x^2)*y - z\"\nz = \"y + (k + x + x^2)*z\"\n"
      "[model.start]\nx = -0.28\n",
      "m = -0.07\nk = 0.2\n", "parameters = [\"m\", \"k\"]\nwindow = [-1, 0.12]\nfrom = -0.5\nto = 0.22\n");
  REQUIRE(kinds(tori) == Names{"tori"});
  CHECK(tori[0].branch.complete());
  check_values(values_at(tori[0], PointType::resonance_1_4, "m"), {1.0 / 32}, 1e-9);
  check_values(values_at(tori[0], PointType::resonance_1_3, "m"), {1.0 / 18}, 1e-9);
  CHECK(value(tori[0], tori[0].branch.points.back(), "m") == 0.12);
}

TEST_CASE("Curves of cycles are as good everywhere as where they begin", "[cycles]") {
  const std::string neuron = R"case(
[model.parameters]
I = 0
eps = 0.5
[model.equations]
v = "v - v^3/3 - w + I"
w = "eps*(v + 0.7 - 0.8*w)"
[branch]
)case";
  const auto curves = traced_of(
      neuron +
          "curve = \"cycle_fold\"\nparameters = [\"I\", \"eps\"]\nwindow = [0, 0.8]\nfrom = 0.07\nto = 1\n",
      {"cycles.intervals=18"});
  REQUIRE(curves.size() == 1);
  const TracedBranch& folds = curves[0];
  CHECK(folds.branch.stop == Stop::left_regime);  // where they shrink
  const auto& orbits = dynamic_cast<const CycleProblem&>(folds.curve->base());
  for (const BranchPoint& point : folds.branch.points) {
    const auto at = folds.curve->split(point.unknowns, point.parameters, point.regime);
    CHECK(orbits.mesh_error(at.unknowns, at.regime) <
          5e-6);  // of 1e-6; what is above is the last on its mesh
  }
  REQUIRE(value(folds, folds.branch.points.front(), "eps") == 0.07);
  const auto branches =
      cycles_of(traced_of(neuron + "parameter = \"I\"\nfrom = 0\nto = 0.8\nswitching = true\n",
                          {"model.parameters.eps=0.07", "cycles.degree=7", "cycles.tolerance=1e-9"}));
  check_values(all_values_at(branches, PointType::fold, "I"),
               {value(folds, folds.branch.points.front(), "I")}, 1e-8);
  // of as many intervals as there are it ends where these no longer suffice
  const auto coarse = cycles_of(traced_of(
      neuron + "parameter = \"I\"\nfrom = 0\nto = 0.8\nswitching = true\n", {"cycles.intervals=10"}));
  REQUIRE(!coarse.empty());
  const auto fold = points(coarse[0], PointType::fold);
  REQUIRE(!fold.empty());
  auto start = continuation::curve_through(*coarse[0].base.problem, "I", fold[0]);
  continuation::TraceOptions options;
  options.parameter = "eps";
  options.from = 0.5;
  options.to = 0.07;
  const auto ended = continuation::trace_curve(*start.problem, start.point, options);
  CHECK(ended.stop == Stop::no_value);
  CHECK(ended.explanation.find("intervals misses more than 1e-06") != std::string::npos);
}

TEST_CASE("Curves of special cycles are followed from where others meet them", "[cycles]") {
  const std::string rest =
      "[model.parameters]\nmu = 0.5\nnu = -0.3\nk = 0.9\n[model.start]\nx = 1.3\n[cycles]\nsettle = "
      "40\n[branch]\n"
      "switching = true\n";
  // folds at mu = 0, r = 1, and doublings at nu = 0.7 (1 - r), mu = (r^2 - 1)^2
  const auto folds =
      traced_of(flipping_pair("mu - (r^2 - 1)^2", "nu + 0.7*(r - 1) - 0.5*ZZ",
                              rest + "curve = \"cycle_fold\"\nparameters = [\"mu\", \"nu\"]\nwindow = [0.5, "
                                     "-0.5]\nfrom = -0.3\nto = 0.4\n"));
  REQUIRE(kinds(folds) == Names{"folds", "doublings"});
  check_values(values_at(folds[1], PointType::fold_flip, "nu"), {0}, 1e-8);
  for (const BranchPoint& point : folds[1].branch.points) {
    const double r = 1 - value(folds[1], point, "nu") / 0.7;
    CHECK_THAT(value(folds[1], point, "mu"), WithinAbs(std::pow(r * r - 1, 2), 1e-8));
  }
  // doublings at mu = 0, and of s = |Z|^2: mu = k s - 0.7 (sqrt(1 + 0.6 s) - 1), which turns where k is this
  const auto doublings =
      traced_of(flipping_pair("1 - r^2 + 0.6*ZZ", "mu + 0.7*(r - 1) - k*ZZ",
                              rest + "curve = \"period_doubling\"\nparameters = [\"mu\", \"k\"]\nwindow = "
                                     "[-0.5, 0.5]\nfrom = 0.1\nto = 1\n"));
  REQUIRE(kinds(doublings) == Names{"doublings", "folds"});
  for (const BranchPoint& point : doublings[1].branch.points) {
    const double k = value(doublings[1], point, "k");
    const double s = (std::pow(0.21 / k, 2) - 1) / 0.6;
    CHECK_THAT(value(doublings[1], point, "mu"), WithinAbs(k * s - 0.7 * (0.21 / k - 1), 1e-7));
  }
  CHECK(value(doublings[1], doublings[1].branch.points.front(), "k") > 0.2);
  CHECK(value(doublings[1], doublings[1].branch.points.back(), "k") == 0.1);
  // tori of maps from resonances 1:2 and 1:1: at determinant 1 of a fixed point
  const auto from_flips = traced_of(doublings_of_map + "switching = true\n");
  REQUIRE(kinds(from_flips) == Names{"doublings", "tori"});
  for (const BranchPoint& point : from_flips[1].branch.points)
    CHECK_THAT(value(from_flips[1], point, "b"), WithinAbs(1, 1e-9));
  const auto from_folds = traced_of(folds_of_map + "switching = true\n");
  REQUIRE(kinds(from_folds) == Names{"folds", "tori"});
  for (const BranchPoint& point : from_folds[1].branch.points) {
    const double x = value(from_folds[1], point, "x");
    CHECK_THAT(value(from_folds[1], point, "b"), WithinAbs(1 - 2 * x, 1e-9));
  }
}

TEST_CASE("Tori of maps are followed from where their curves meet folds", "[cycles]") {
  // x = +-sqrt(mu) beside a pair of modulus 1 + q - 0.5 x
  const auto all = traced_of(R"case(
[model]
kind = "map"
[model.parameters]
mu = 0.04
q = -0.3
[model.definitions]
r = "1 + q - 0.5*x - y^2 - z^2"
[model.equations]
x = "x + mu - x^2"
y = "r*(0.6*y - 0.8*z)"
z = "r*(0.8*y + 0.6*z)"
[model.start]
x = 0.2
[branch]
curve = "fold"
switching = true
parameters = ["mu", "q"]
window = [0.1, -0.1]
from = -0.3
to = 0.2
)case");
  REQUIRE(kinds(all) == Names{"folds", "tori"});
  check_values(all_values_at({all[0]}, PointType::fold_neimark_sacker, "q"), {0}, 1e-9);
  double least = 0;
  double largest = 0;
  for (const BranchPoint& point : all[1].branch.points) {
    const double q = value(all[1], point, "q");
    CHECK_THAT(value(all[1], point, "mu"), WithinAbs(4 * q * q, 1e-9));
    least = std::min(least, q);
    largest = std::max(largest, q);
  }
  CHECK_THAT(least, WithinAbs(-std::sqrt(0.1) / 2, 1e-9));
  CHECK_THAT(largest, WithinAbs(std::sqrt(0.1) / 2, 1e-9));
}

TEST_CASE("Generalised Hopf points are told beside what decays far faster", "[cycles]") {
  // r' = (mu + b s - s^2) r, s = r^2: folds at mu = -b^2/4
  const auto curves = from_hopf_points(
      R"case(
x = "(mu + b*s - s^2)*x - y"
y = "x + (mu + b*s - s^2)*y"
z = "1e5*(x - z)"
[model.definitions]
s = "x^2 + y^2"
)case",
      "mu = -1\nb = -0.2\n", "parameters = [\"mu\", \"b\"]\nwindow = [-1, 1]\nfrom = -0.5\nto = 0.5\n");
  REQUIRE(kinds(curves) == Names{"folds"});
  check_curve(
      curves[0], "mu",
      [&](const BranchPoint& point) { return -std::pow(value(curves[0], point, "b"), 2) / 4; }, 1e-8);
}

TEST_CASE("No generalised Hopf point is told on a Bogdanov-Takens point", "[cycles]") {
  const auto found = all_values_at(of_two_populations(), PointType::generalized_hopf, "q");
  check_values(found, {-7.58350585, -8 + 7.58350585}, 1e-8);
}

TEST_CASE("Folds of cycles end where an orbit that comes near an equilibrium hides them", "[cycles]") {
  const auto folds = of_cycles(of_two_populations());
  REQUIRE(kinds(folds) == Names{"folds", "folds"});
  for (const TracedBranch& one : folds) {
    CHECK(one.branch.stop == Stop::no_value);
    CHECK(points(one, PointType::cusp).empty());
  }
}
