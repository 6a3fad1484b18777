// The case files of the library's problems against published answers, and all of them against their
// equations.

#include <algorithm>
#include <filesystem>
#include <numbers>
#include <vector>

#include "arcslip/cases/study_case.hpp"
#include "arcslip/continuation/cycles/cycle_problem.hpp"
#include "case_runs.hpp"
#include "cases/design_study.hpp"
#include "library_cases.hpp"
#include "places.hpp"
#include "temporary_folder.hpp"

using namespace arcslip;
using namespace arcslip::testing;

namespace {

double residual_of(const continuation::Atlas& surface, const continuation::Problem& problem) {
  Vector residual(problem.size());
  double worst = 0;
  for (const continuation::Chart& chart : surface.charts) {
    REQUIRE(problem.evaluate(chart.unknowns, chart.parameters, {}, {&residual}));
    worst = std::max(worst, residual.lpNorm<Eigen::Infinity>());
  }
  return worst;
}

/// Those of one part of all cases in equal ones, which are tests of their own that run side by side.
void trace_cases(std::size_t part, std::size_t parts) {
  std::vector<std::filesystem::path> all;
  for (const auto& entry : std::filesystem::directory_iterator(source_folder() + "/problems")) {
    if (entry.path().extension() != ".toml") continue;
    if (read(entry.path()).find("\n[branch]") == std::string::npos) continue;  // a study, see below
    all.push_back(entry.path());
  }
  CHECK(all.size() >= 22);
  std::sort(all.begin(), all.end());
  for (std::size_t i = part; i < all.size(); i += parts) {
    INFO(all[i].stem());
    const Run run(all[i].stem());
    CHECK(run.traced.size() >= run.input.branches.size());
    for (const TracedBranch& one : run.traced) {
      INFO(one.branch.explanation);
      const bool is_of_orbits =
          dynamic_cast<const continuation::OrbitProblem*>(one.base.problem.get()) != nullptr;
      CHECK((one.branch.complete() || (is_of_orbits && is_end(one.branch.stop))));
      const Stop first = one.branch.first_stop.value_or(Stop::reached_end);  // of what is traced both ways
      CHECK((first == Stop::reached_end || first == Stop::left_range || first == Stop::left_regime ||
             first == Stop::infinite_period || first == Stop::requested));
      CHECK((one.surface ? one.surface->charts.size() : one.branch.points.size()) > 1);
      double worst = one.surface ? residual_of(*one.surface, one.problem()) : 0;
      for (const BranchPoint& point : one.branch.points)
        worst = std::max(worst, one.curve ? residual_of_base(one, point) : point.residual);
      CHECK(worst <= one.request->options.tolerance);
    }
  }
}

}  // namespace

TEST_CASE("Every case is traced to its end, and every point of it solves its equations: part 1 of 4",
          "[cases][long]") {
  trace_cases(0, 4);
}

TEST_CASE("Every case is traced to its end, and every point of it solves its equations: part 2 of 4",
          "[cases][long]") {
  trace_cases(1, 4);
}

TEST_CASE("Every case is traced to its end, and every point of it solves its equations: part 3 of 4",
          "[cases][long]") {
  trace_cases(2, 4);
}

TEST_CASE("Every case is traced to its end, and every point of it solves its equations: part 4 of 4",
          "[cases][long]") {
  trace_cases(3, 4);
}

TEST_CASE("Every study's case is read, and its last design has an optimum", "[cases]") {
  int cases = 0;
  for (const auto& entry : std::filesystem::directory_iterator(source_folder() + "/problems")) {
    if (entry.path().extension() != ".toml") continue;
    if (read(entry.path()).find("\n[study]") == std::string::npos) continue;
    ++cases;
    INFO(entry.path().stem());
    const StudyCase study = read_study(entry.path());
    const problems::PreloadStudy result = study_preload(study, study.design(study.items() - 1));
    CHECK(result.failure.empty());
    CHECK(result.optimum.has_value());
  }
  CHECK(cases >= 3);
}

// ---- Problems with published answers ----

TEST_CASE("The stirred tank's case has the Hopf points and folds of AUTO's demo ab", "[cases]") {
  const Run run("ab");
  check(run.traced[0], PointType::hopf,
        {{{"p1", 0.120865719509}, {"u1", 0.322062481732}}, {{"p1", 0.217080509696}}});
  check(run.traced[0], PointType::fold,
        {{{"p1", 0.121901160811}, {"u1", 0.378732187482}}, {{"p1", 0.117014750427}, {"u1", 0.621267812518}}});
  const std::map<std::string, double> cooler = {
      {"14", 0.165042045324}, {"15", 0.146882475604}, {"16", 0.132538444269}};
  for (const auto& [p2, p1] : cooler) {
    const Run other("ab", {"system.p2=" + p2});
    REQUIRE(count(other.traced[0], PointType::hopf) >= 1);
    CHECK_THAT(points(other.traced[0], PointType::hopf)[0].parameters(0), WithinRel(p1, published));
  }
}

TEST_CASE("The cusp's case has its folds at +-2/(3 sqrt 3), as AUTO's demo cusp", "[cases]") {
  const Run run("cusp");
  const double mu = 2 / (3 * std::sqrt(3));
  const double x = 1 / std::sqrt(3);
  check(run.traced[0], PointType::fold, {{{"mu", mu}, {"x", -x}}, {{"mu", -mu}, {"x", x}}});
}

TEST_CASE("The enzyme's case has the folds and branch points of AUTO's demo enz on both branches",
          "[cases]") {
  const Run run("enz");
  REQUIRE(run.traced.size() == 2);
  const auto both = [](double s0, double s) {
    return std::map<std::string, double>{{"s0", s0}, {"s1", s}, {"s2", s}};
  };
  check(run.traced[0], PointType::fold,
        {both(34.356924998526, 1.048361974182), both(18.887067657924, 8.822200333433)});
  check(run.traced[0], PointType::branch_point,
        {both(34.222886544190, 1.174173719128), both(22.181637926124, 4.394472751983)});

  const TracedBranch& asymmetric = run.traced[1];
  CHECK(asymmetric.branch.stop == Stop::closed_loop);
  CHECK(count(asymmetric, PointType::branch_point) == 1);  // the other one: it starts on the first
  const double low[] = {25.3727148381, 5.884079982224, 0.571738506069};
  const double high[] = {26.6220717700, 8.782806716865, 1.047955078278};
  std::vector<BranchPoint> folds = points(asymmetric, PointType::fold);
  REQUIRE(folds.size() == 4);
  int seen = 0;  // each with its mirror image
  for (const BranchPoint& fold : folds) {
    for (const auto& one : {low, high}) {
      for (const int first : {0, 1}) {
        if (std::abs(fold.unknowns(first) - one[1]) > 1e-3) continue;
        CHECK_THAT(fold.parameters(0), WithinRel(one[0], published));
        CHECK_THAT(fold.unknowns(first), WithinRel(one[1], published));
        CHECK_THAT(fold.unknowns(1 - first), WithinRel(one[2], published));
        ++seen;
      }
    }
  }
  CHECK(seen == 4);
}

TEST_CASE("From all solutions at a value the enzyme's closed branch is found without its branch points",
          "[cases]") {
  const Run run("enz", {"branch.switching=false", "branch.start=24", "branch.all_solutions=true"});
  REQUIRE(run.traced.size() == 2);  // of the five solutions three lie on the first branch
  CHECK(count(run.traced[0], PointType::user) + count(run.traced[0], PointType::start) == 3);
  CHECK(run.traced[1].branch.stop == Stop::closed_loop);
  CHECK(count(run.traced[1], PointType::fold) == 4);
  for (const BranchPoint& point : points(run.traced[1], PointType::user)) CHECK(point.parameters(0) == 24);
}

TEST_CASE("The predator's case has the points of AUTO's demo pp2 on all its branches", "[cases]") {
  const Run run("pp2");
  REQUIRE(run.traced.size() == 6);
  check(run.traced[0], PointType::branch_point, {{{"p", 0.6}, {"u", 0}, {"v", 0}}});
  check(run.traced[1], PointType::branch_point,
        {{{"p", 2.0 / 3 / (1 - std::exp(-5.0 / 3))}, {"u", 1.0 / 3}, {"v", 0}}});
  check(run.traced[1], PointType::fold, {{{"p", 0.832929322234}, {"u", 0.41116156075}}});
  check(run.traced[4], PointType::hopf, {{{"p", 0.671593847479}, {"u", 1.0 / 3}, {"v", 0.365761536}}});
  const double period = 10.38916998420;
  CHECK_THAT(omega_of(points(run.traced[4], PointType::hopf)[0]),
             WithinRel(2 * std::numbers::pi / period, published));
  // the last one is of the cycles that leave there
  const BranchPoint& first = run.traced[5].branch.points.front();
  CHECK_THAT(value(run.traced[5], first, "T"), WithinRel(period, 1e-5));
  CHECK_THAT(value(run.traced[5], first, "p"), WithinRel(0.671593847479, 1e-5));
}

TEST_CASE("The case of Freudenstein and Roth has the folds and extrema of PITCON's problem 1", "[cases]") {
  const Run run("freudenstein_roth", {"branch.extrema_of=[\"x1\"]"});
  check(run.traced[0], PointType::fold,
        {{{"x3", 0.5875873254}, {"x1", 20.4858578279}, {"x2", -0.8968052533}},
         {{"x3", -0.6863527575}, {"x1", 61.0203150116}, {"x2", 2.2301385866}}});
  check(run.traced[0], PointType::trough,
        {{{"x1", 14.2830912501}, {"x2", -1.7413768922}, {"x3", 0.2585778714}}});
  check(run.traced[0], PointType::peak,
        {{{"x1", 61.6693625811}, {"x2", 1.9838011346}, {"x3", -0.6638797422}}});
  check(run.traced[0], PointType::end, {{{"x1", 5}, {"x2", 4}, {"x3", 1}}});
}

TEST_CASE("The case of Lorenz 1984 has the Hopf points and the fold of BifurcationKit's test", "[cases]") {
  const Run run("lorenz84");
  check(run.traced[0], PointType::fold, {{{"F", 1.546648372598}, {"X", 1.3117855253}, {"U", -0.157027585}}});
  check(run.traced[0], PointType::hopf,
        {{{"F", 1.619657820943}, {"X", 1.2188295236}},
         {{"F", 2.467222123113}, {"X", 1.1289637935}},
         {{"F", 2.859875412748}, {"X", 1.118508101}}});
}

TEST_CASE("The curve of folds of Lorenz 1984 has its published points of codimension two", "[cases]") {
  // BifurcationKit.jl, test/hopf_codim_2/lorenz84.jl, as recomputed
  const Run run("lorenz84_fold_curve");
  REQUIRE(run.traced.size() == 1);
  check(run.traced[0], PointType::bogdanov_takens, {{{"F", 1.446716701115}, {"T", 0.020940169683}}});
  check(run.traced[0], PointType::zero_hopf, {{{"F", 1.283419296138}, {"T", 1.265408341e-4}}});
  CHECK_THAT(omega_of(points(run.traced[0], PointType::zero_hopf)[0]), WithinRel(1.0990516362, published));
}

TEST_CASE("The Hopf curves of Lorenz 1984 meet the curve of folds and each other", "[cases]") {
  const Run run("lorenz84_hopf_curve");
  REQUIRE(run.traced.size() == 2);  // of three Hopf points: two lie on one curve
  check(run.traced[0], PointType::bogdanov_takens, {{{"F", 1.446716701115}, {"T", 0.020940169683}}});
  check(run.traced[1], PointType::zero_hopf, {{{"F", 1.283419296138}, {"T", 1.265408341e-4}}});
  // Where two pairs lie on the imaginary axis either curve has the same state.
  const auto one = points(run.traced[0], PointType::hopf_hopf);
  const auto other = points(run.traced[1], PointType::hopf_hopf);
  REQUIRE((one.size() == 1 && other.size() == 1));
  for (const std::string name : {"F", "T", "X", "Y", "Z", "U"}) {
    CHECK_THAT(value(run.traced[0], one[0], name),
               WithinRel(value(run.traced[1], other[0], name), published));
  }
}

TEST_CASE("The cusp's curve lies on 27 mu^2 = 4 lambda^3, through (2, 3) and the tip", "[cases]") {
  const Run run("cusp_curve");
  REQUIRE(run.traced.size() == 1);
  check(run.traced[0], PointType::cusp, {{{"mu", 0}, {"lambda", 0}, {"x", 0}}});
  check(run.traced[0], PointType::end,
        {{{"mu", -2}, {"lambda", 3}, {"x", 1}}, {{"mu", 2}, {"lambda", 3}, {"x", -1}}});
  for (const BranchPoint& point : run.traced[0].branch.points) {
    const double mu = value(run.traced[0], point, "mu");
    const double lambda = value(run.traced[0], point, "lambda");
    CHECK_THAT(27 * mu * mu, WithinAbs(4 * lambda * lambda * lambda, 1e-8));  // 108 times the tolerance on F
  }
}

TEST_CASE("Bratu's cases converge to the exact fold and the exact solutions as h^2", "[cases]") {
  // Richardson's extrapolation takes the h^2 away; what is left is h^4 = 6e-10 times a factor of order ten.
  const Run coarse("bratu", {"system.intervals=200"});
  const Run fine("bratu", {"system.intervals=400"});
  const auto extrapolated = [&](PointType type, std::size_t i, const std::string& name) {
    const double a = value(coarse.traced[0], points(coarse.traced[0], type).at(i), name);
    const double b = value(fine.traced[0], points(fine.traced[0], type).at(i), name);
    return (4 * b - a) / 3;
  };
  CHECK_THAT(extrapolated(PointType::fold, 0, "lambda"), WithinRel(3.51383071912516, 1e-8));
  const double middle[] = {0.140539214400, 0.328952421341, 0.640146696041,
                           1.975266971163, 2.895531265493, 4.091467246189};
  const double slope[] = {0.5493527288, 0, 2.3196022581, 6.1033812941, 0, 10.8468990194};
  REQUIRE(count(coarse.traced[0], PointType::user) == 6);
  for (std::size_t i = 0; i < 6; ++i) {
    CHECK_THAT(extrapolated(PointType::user, i, "u_mid"), WithinRel(middle[i], 1e-8));
    if (slope[i] != 0) CHECK_THAT(extrapolated(PointType::user, i, "slope"), WithinRel(slope[i], 1e-7));
  }
  const auto square = [](int intervals) {
    const Run run("bratu_2d", {"system.intervals=" + std::to_string(intervals)});
    return value(run.traced[0], points(run.traced[0], PointType::fold).at(0), "lambda");
  };
  // h^4 = 6e-8 on the finest of these meshes, times a factor of order ten; Boyd, J. Sci. Comput. 1 (1986) 183
  CHECK_THAT((4 * square(64) - square(32)) / 3, WithinRel(6.808124423, 1e-6));
}

TEST_CASE("Duffing's case has the folds of NLvib's example for every number of harmonics", "[cases]") {
  const auto check_folds = [](const Settings& settings, double upper, double lower) {
    const Run run("duffing", settings);
    check(run.traced[0], PointType::fold, {{{"W", upper}}, {{"W", lower}}});
  };
  check_folds({"system.harmonics=1"}, 1.267536959513, 1.115585927182);
  check_folds({"system.harmonics=3"}, 1.269600032145, 1.115700246882);
  check_folds({"system.harmonics=5"}, 1.269601954391, 1.115700251771);
  check_folds({"system.harmonics=9"}, 1.269601955546, 1.115700251771);
  check_folds({"system.harmonics=1", "system.force=0.06"}, 1.051404521411, 1.049467203819);
  check_folds({"system.harmonics=1", "system.force=0.1"}, 1.115508359522, 1.076067057413);
  check_folds({"system.harmonics=1", "system.force=0.3"}, 1.489393339365, 1.161865303909);
}

TEST_CASE("The Lur'e system's case has the period doubling of AUTO", "[cases]") {
  const Run run("lure");
  check(run.traced[0], PointType::period_doubling, {{{"a", 0.6303020062}, {"T", 6.3640713394}}});
}

// ---- Friction ----

TEST_CASE("Two points of codimension two that lie within one step are both found", "[cases]") {
  // T <-> -T, U <-> -U is a symmetry of the model: the zero-Hopf points lie at T = -+1.265408341e-4.
  const Run run("lorenz84_hopf_curve", {"branch.from=-0.01"});
  std::vector<double> found;
  for (const TracedBranch& curve : run.traced) {
    for (const BranchPoint& point : points(curve, PointType::zero_hopf))
      found.push_back(value(curve, point, "T"));
  }
  REQUIRE(found.size() == 2);
  CHECK_THAT(std::abs(found[0]), WithinRel(1.265408341e-4, published));
  CHECK_THAT(found[0] + found[1], WithinAbs(0, 1e-10));
}
