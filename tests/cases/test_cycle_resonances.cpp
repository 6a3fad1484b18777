// Points of codimension two on curves of special points of cycles and maps.

#include "cycle_cases.hpp"
#include "temporary_folder.hpp"

namespace {

using namespace arcslip;
using namespace arcslip::testing;

std::vector<double> at(const std::vector<TracedBranch>& all, PointType type, const std::string& name) {
  return all_values_at(all, type, name);
}

const std::string torus_case = R"case(
[model.definitions]
s = "u^2 + v^2"
r2 = "x^2 + y^2"
grow = "mu + 0.7*(sqrt(r2) - 1) - k*s"
[model.equations]
x = "x*(1 - r2 + 0.6*s) - y"
y = "y*(1 - r2 + 0.6*s) + x"
u = "grow*u - w*v"
v = "grow*v + w*u"
[model.start]
x = 1
[cycles]
settle = 30
[branch]
curve = "neimark_sacker"
window = [-0.5, 0.5]
)case";

/// w -> mu w (1 + (-k + 0.5 1.2) |w|^2), in other coordinates.
const std::string torus_map = R"case(
[model]
kind = "map"
[model.parameters]
p = -0.2
w = 1.3
k = 0.9
[model.definitions]
Y = "y - 0.4*x^2"
Z = "z + 0.3*x*Y"
s = "x^2 + Y^2"
g = "(1 + p)*(1 - k*s + 0.5*Z)"
xx = "g*(cos(w)*x - sin(w)*Y)"
yy = "g*(sin(w)*x + cos(w)*Y)"
zz = "Z/2 + 0.6*s"
[model.equations]
x = "xx"
y = "yy + 0.4*xx^2"
z = "zz - 0.3*xx*yy"
[branch]
curve = "neimark_sacker"
window = [-0.2, 0.2]
)case";

}  // namespace

TEST_CASE("Period doublings are generalised where their coefficient vanishes", "[cycles]") {
  const auto all = traced_of(flipping_pair(
      "1 - r^2 + 0.6*ZZ", "mu + 0.7*(r - 1) - k*ZZ",
      "[model.parameters]\nmu = -0.5\nk = 0.9\n[model.start]\nx = 1\n[cycles]\nsettle = 30\n[branch]\ncurve "
      "= "
      "\"period_doubling\"\nparameters = [\"mu\", \"k\"]\nwindow = [-0.5, 0.5]\nfrom = -1\nto = 1\n"));
  REQUIRE(all.size() == 1);
  check_values(at(all, PointType::generalized_period_doubling, "k"), {0.7 * 0.3}, 1e-8);
  CHECK(at(all, PointType::fold_flip, "k").empty());
}

TEST_CASE("A multiplier 1 on a curve of period doublings, and -1 on one of folds, are one point",
          "[cycles]") {
  const std::string rest =
      "[model.parameters]\nmu = 0.5\nnu = -0.3\n[model.start]\nx = 1.3\n[cycles]\nsettle = 40\n";
  const auto folds =
      traced_of(flipping_pair("mu - (r^2 - 1)^2", "nu + 0.7*(r - 1) - 0.5*ZZ",
                              rest + "[branch]\ncurve = \"cycle_fold\"\nparameters = [\"mu\", "
                                     "\"nu\"]\nwindow = [0.5, -0.5]\nfrom = -0.3\nto = 0.4\n"));
  check_values(at(folds, PointType::fold_flip, "nu"), {0}, 1e-8);
  const auto flips =
      traced_of(flipping_pair("mu - (r^2 - 1)^2", "nu + 0.7*(r - 1) - 0.5*ZZ",
                              rest + "[branch]\ncurve = \"period_doubling\"\nparameters = [\"nu\", "
                                     "\"mu\"]\nwindow = [-0.5, 0.5]\nfrom = 0.5\nto = -0.5\n"));
  check_values(at(flips, PointType::fold_flip, "mu"), {0}, 1e-8);
}

TEST_CASE("Curves of tori of cycles pass their strong resonances", "[cycles]") {
  const auto all = traced_of("[model.parameters]\nmu = -0.5\nw = 0.3\nk = 0.9\n" + torus_case +
                             "parameters = [\"mu\", \"w\"]\nfrom = 0.05\nto = 0.45\n");
  REQUIRE(all.size() == 1);
  check_values(at(all, PointType::resonance_1_3, "w"), {1.0 / 3}, 1e-8);
  check_values(at(all, PointType::resonance_1_4, "w"), {0.25}, 1e-8);
  CHECK(at(all, PointType::resonance_1_1, "w").empty());
  CHECK(at(all, PointType::chenciner, "w").empty());
}

TEST_CASE("Tori have a Chenciner point where their coefficient vanishes", "[cycles]") {
  const auto all = traced_of("[model.parameters]\nmu = -0.5\nw = 0.3\nk = 0.9\n" + torus_case +
                             "parameters = [\"mu\", \"k\"]\nfrom = -0.5\nto = 0.9\n");
  REQUIRE(all.size() == 1);
  check_values(at(all, PointType::chenciner, "k"), {0.7 * 0.3}, 1e-8);
}

TEST_CASE("Curves of tori end where the pair of multipliers meets", "[cycles]") {
  const auto all = traced_of(R"case(
[model]
kind = "map"
[model.parameters]
b = 0.5
q = 0.3
[model.equations]
x = "y"
y = "-b*x + q*y - 0.4*x^2*y + 0.3*x*y"
[branch]
curve = "neimark_sacker"
parameters = ["b", "q"]
window = [0.5, 1.5]
from = -3
to = 3
)case");
  REQUIRE(all.size() == 1);
  for (const BranchPoint& point : all[0].branch.points)
    CHECK_THAT(value(all[0], point, "b"), WithinAbs(1, 1e-9));
  check_values(at(all, PointType::resonance_1_1, "q"), {2}, 1e-7);
  check_values(at(all, PointType::resonance_1_2, "q"), {-2}, 1e-7);
  check_values(at(all, PointType::resonance_1_3, "q"), {-1}, 1e-8);
  check_values(at(all, PointType::resonance_1_4, "q"), {0}, 1e-8);
}

TEST_CASE("No Chenciner point is told where the coefficient vanishes or cancels but for rounding",
          "[cycles]") {
  // The generalised Henon map: det = beta + R x = 1 and the trace (R - 2) x. At R = 0 it keeps areas there.
  const auto curve_at = [](const std::string& R) {
    return traced_of(R"case(
[model]
kind = "map"
[model.parameters]
alpha = 2
beta = 0.5
R = 0
[model.equations]
x = "y"
y = "alpha - beta*x - y^2 + R*x*y"
[model.start]
x = 1
y = 1
[branch]
curve = "neimark_sacker"
parameters = ["beta", "alpha"]
window = [0.5, 2.5]
from = -1.5
to = 4
)case",
                     {"model.parameters.R=" + R});
  };
  const auto bent = curve_at("-0.1");
  REQUIRE(bent.size() == 1);
  check_values(at(bent, PointType::resonance_1_3, "beta"), {20.0 / 21}, 1e-9);
  CHECK(at(bent, PointType::chenciner, "beta").empty());
  const auto kept = curve_at("0");
  REQUIRE(kept.size() == 1);
  check_values(at(kept, PointType::resonance_1_3, "alpha"), {1.25}, 1e-9);
  CHECK(at(kept, PointType::chenciner, "alpha").empty());
}

TEST_CASE("Curves of maps have the same points as those of cycles", "[cycles]") {
  const auto turns = traced_of(torus_map + "parameters = [\"p\", \"w\"]\nfrom = 0.2\nto = 3.1\n");
  REQUIRE(turns.size() == 1);
  check_values(at(turns, PointType::resonance_1_3, "w"), {two_pi / 3}, 1e-8);
  check_values(at(turns, PointType::resonance_1_4, "w"), {pi / 2}, 1e-8);
  CHECK(at(turns, PointType::chenciner, "w").empty());
  const auto bent = traced_of(torus_map + "parameters = [\"p\", \"k\"]\nfrom = 0.2\nto = 0.9\n");
  REQUIRE(bent.size() == 1);
  check_values(at(bent, PointType::chenciner, "k"), {0.6}, 1e-8);
  // x -> -(1 + p) x + a x^2 + k x^3: c = -(a^2 + k)
  const auto flips = traced_of(R"case(
[model]
kind = "map"
[model.parameters]
p = -0.5
k = 1
[model.equations]
x = "-(1 + p)*x + 0.7*x^2 + k*x^3"
[branch]
curve = "period_doubling"
parameters = ["p", "k"]
window = [-0.5, 0.5]
from = -1
to = 1
)case");
  REQUIRE(flips.size() == 1);
  CHECK(at(flips, PointType::fold_flip, "k").empty());
  check_values(at(flips, PointType::generalized_period_doubling, "k"), {-0.49}, 1e-8);
}

TEST_CASE("Curves of tori end where those of folds and period doublings tell it", "[cycles]") {
  // A fixed point of trace q and determinant b: b = -1 - q, and a second multiplier -1 at b = 1.
  const auto flips = traced_of(doublings_of_map);
  REQUIRE(flips.size() == 1);
  check_values(at(flips, PointType::resonance_1_2, "q"), {-2}, 1e-8);
  CHECK(at(flips, PointType::fold_flip, "q").empty());
  // x = y, x^2 = mu: a fold at mu = 0, of multipliers 1 and b.
  const auto folds = traced_of(folds_of_map);
  REQUIRE(folds.size() == 1);
  check_values(at(folds, PointType::resonance_1_1, "b"), {1}, 1e-8);
  // Lorenz' flow of 1984: tori of the doubled cycles end on the curve of doublings.
  const auto flow = [](const std::string& curve) {
    return traced_of(R"case(
[model.parameters]
F = 1
G = 1.5
[model.equations]
x = "-y^2 - z^2 - x/4 + F/4"
y = "x*y - 4*x*z - y + G"
z = "4*x*y + x*z - z"
[model.start]
x = 7.9
[branch]
parameters = ["F", "G"]
window = [8, 0.5]
from = 1.3
to = 1.8
)case"
                     "curve = \"" +
                     curve + "\"\n");
  };
  const auto tori = flow("neimark_sacker");
  const auto doublings = flow("period_doubling");
  const auto resonances = at(doublings, PointType::resonance_1_2, "G");
  REQUIRE(resonances.size() == 1);
  REQUIRE(tori.size() == 1);
  const BranchPoint& last = tori[0].branch.points.back();
  CHECK(tori[0].branch.stop == Stop::left_regime);
  CHECK_THAT(value(tori[0], last, "G"), WithinAbs(resonances[0], 3e-5));
  CHECK_THAT(value(tori[0], last, "F"), WithinAbs(at(doublings, PointType::resonance_1_2, "F")[0], 3e-5));
}

TEST_CASE("Coefficients that are one term vanish where it does", "[cycles]") {
  const auto flips = traced_of(R"case(
[model]
kind = "map"
[model.parameters]
p = -0.5
k = 0.7
[model.equations]
x = "-(1 + p)*x + k*x^3"
[branch]
curve = "period_doubling"
parameters = ["p", "k"]
window = [-0.5, 0.5]
from = -1
to = 1
)case");
  check_values(at(flips, PointType::generalized_period_doubling, "k"), {0}, 1e-8);
  const auto hopf = traced_of(R"case(
[model.parameters]
mu = 0
nu = -0.3
[model.definitions]
s = "x^2 + y^2"
g = "mu + nu*s - s^2"
[model.equations]
x = "g*x - y"
y = "x + g*y"
[branch]
curve = "hopf"
parameters = ["mu", "nu"]
window = [-0.5, 0.5]
from = -0.5
to = 1
)case");
  check_values(at(hopf, PointType::generalized_hopf, "nu"), {0}, 1e-8);
}

TEST_CASE("Curves of tori end on the folds of cycles, on two meshes and on branches across them",
          "[cycles][numbers]") {
  const Run usual("peroxidase_tori");
  const Run fine("peroxidase_tori",
                 {"cycles.degree=6", "cycles.intervals=60", "cycles.tolerance=1e-9", "branch.from=0.5"});
  std::vector<double> resonances;
  for (const Run* run : {&usual, &fine}) {
    REQUIRE(run->traced.size() == 2);
    check_values(at(run->traced, PointType::start, "k7"), {0.716433564, 0.818565885},
                 1e-8);  // MatCont, AUTO-07p
    CHECK(at(run->traced, PointType::branch_point, "k7").empty());
    CHECK(count(run->traced[0], PointType::chenciner) == 0);
    check_values(values_at(run->traced[1], PointType::chenciner, "k7"), {1.757359574}, 1e-8);
    for (const TracedBranch& traced : run->traced) CHECK(traced.branch.stop == Stop::requested);
    resonances = at(run->traced, PointType::resonance_1_1, "k8");
    check_values(resonances, {0.72395704, 0.93042203}, 1e-8);
  }
  // by a second multiplier at 1 on the curve of folds itself
  const Run folds("peroxidase_tori",
                  {"branch.curve=cycle_fold", "model.parameters.k8=0.75", "branch.from=0.7", "branch.to=1"});
  REQUIRE(folds.traced.size() == 1);
  check_values(at(folds.traced, PointType::resonance_1_1, "k8"), resonances, 1e-7);
  // tori leave cycles beside their fold on one side of it alone
  const std::string text = read(source_folder() + "/problems/peroxidase_tori.toml");
  const std::string across = text.substr(0, text.find("[branch]")) +
                             "[branch]\nparameter = \"k7\"\nfrom = 4\nto = 1.15\nswitching = true\n";
  const double resonance = at(usual.traced, PointType::resonance_1_1, "k7")[0];
  for (const double beside : {-2e-3, 0.0, 2e-3}) {
    const auto all = traced_of(across, {"model.parameters.k8=" + std::to_string(resonances[0] + beside)});
    REQUIRE(all.size() == 2);
    CHECK(count(all[1], PointType::fold) == 2);
    if (beside == 0) CHECK_THAT(at(all, PointType::fold, "k7")[0], WithinAbs(resonance, 1e-6));
    if (beside != 0) CHECK(count(all[1], PointType::neimark_sacker) == (beside < 0 ? 2 : 1));
  }
}

TEST_CASE("A curve of cycles without one to begin on says why there is none", "[cycles]") {
  const auto why = [](const std::string& name, const Settings& settings) {
    const Run run(name, settings);
    REQUIRE(run.traced.size() == 1);
    CHECK(run.traced[0].branch.points.empty());
    return run.traced[0].branch.explanation;
  };
  CHECK(why("peroxidase_tori", {"branch.window=[0, 4]"}) ==
        "no neimark_sacker was found for k7 = 0 to 4 at k8 = 0.5: no solution was found from the guess at "
        "k7 = 0: Newton's method diverges");
  CHECK(why("enzyme_cycle_folds", {"model.parameters.s0=1", "branch.from=0.5", "branch.to=2"}) ==
        "no cycle_fold was found for rho = 0 to 6 at s0 = 1: no cycles were found");
}

TEST_CASE("A curve of tori goes on past a cube root of 1, where its coefficient is not known", "[cycles]") {
  const auto all = traced_of(R"case(
[model]
kind = "forced"
period = "2*pi/W"
[model.parameters]
W = 1
F = 1
mu = 0.3
[model.equations]
x = "y"
y = "mu*(1 - x^2)*y - x + F*cos(W*t)"
[model.start]
x = 1
[branch]
curve = "neimark_sacker"
parameters = ["W", "F"]
window = [1.2, 1.6]
from = 1
to = 2
)case");
  REQUIRE(all.size() == 1);
  CHECK(at(all, PointType::resonance_1_3, "F").size() == 1);
  CHECK(all[0].branch.complete());
  CHECK(all[0].branch.work.rejected_steps <= 3);  // not ever shorter ones beside this point
}
