// The algebraic problems of the library against their published answers. Numbers of ten and more digits were
// recomputed from the equations with a second program; each agrees with the source named beside it to the
// source's digits.

#include <cmath>
#include <random>
#include <set>

#include "arcslip/continuation/path/newton.hpp"
#include "arcslip/continuation/points/normal_form.hpp"
#include "arcslip/continuation/problem/derivative_check.hpp"
#include "catch.hpp"
#include "library_cases.hpp"

using namespace arcslip;
using namespace arcslip::continuation;
using namespace arcslip::testing;

namespace {

// The published values have ten to twelve digits, of numbers down to 0.1.
constexpr double published_textbook = 1e-9;

/// What the engine's points are to satisfy by their definition.
constexpr double defining = 1e-10;

struct Special {
  PointType type;
  double parameter;
  std::vector<double> unknowns = {};
  double omega = 0;
};

/// The folds, branch points and Hopf points of a branch, in their order.
std::vector<BranchPoint> special_points(const Branch& branch) {
  std::vector<BranchPoint> points;
  for (const BranchPoint& point : branch.points) {
    if (point.type == PointType::fold || point.type == PointType::branch_point ||
        point.type == PointType::hopf)
      points.push_back(point);
  }
  return points;
}

void check_points(const Problem& problem, Index active, const std::vector<BranchPoint>& found,
                  const std::vector<Special>& expected) {
  REQUIRE(found.size() == expected.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    CAPTURE(i, expected[i].parameter);
    CHECK(found[i].type == expected[i].type);
    CHECK_THAT(found[i].parameters(active), WithinRel(expected[i].parameter, published_textbook));
    for (std::size_t k = 0; k < expected[i].unknowns.size(); ++k) {
      const double value = expected[i].unknowns[k];
      CHECK_THAT(found[i].unknowns(static_cast<Index>(k)),
                 WithinRel(value, published_textbook) || WithinAbs(value, published_textbook));
    }
    if (expected[i].omega > 0)
      CHECK_THAT(omega_of(found[i]), WithinRel(expected[i].omega, published_textbook));
    CHECK(defining_residual(problem, active, found[i]) <= defining);
  }
}

void check_branch(const Instance& instance, const TraceOptions& options,
                  const std::vector<Special>& expected) {
  const Branch branch = instance.trace(options);
  INFO(branch.explanation);
  REQUIRE(branch.complete());
  check_points(*instance.problem, instance.parameter(options.parameter), special_points(branch), expected);
}

/// The branch that leaves a branch point in the direction that changes `along` . u most, so that it grows.
Branch switched(const Instance& instance, const BranchPoint& from, const Vector& along,
                const TraceOptions& options) {
  Guess guess{from.unknowns, from.parameters, from.regime, {}};
  const auto form = branch_point_form(*instance.problem, instance.parameter(options.parameter), guess);
  REQUIRE(form);
  double most = 0;
  for (const Vector& direction : form->directions) {
    REQUIRE(direction.size() == from.unknowns.size() + 1);
    const double rate = along.dot(direction.head(along.size()));
    if (std::abs(rate) <= std::abs(most)) continue;
    most = rate;
    guess.direction = std::copysign(1.0, rate) * direction;
  }
  return trace(*instance.problem, guess, options);
}

}  // namespace

TEST_CASE("Every model of the library is complete and in its place", "[library]") {
  std::string last;
  for (const problems::LibraryModel& model : problems::library()) {
    CAPTURE(model.name);
    CHECK(last < model.name);
    last = model.name;
    CHECK_FALSE(model.title.empty());
    CHECK(problems::find_model(model.name) == &model);
    const Instance instance(model.name);
    std::set<std::string> settings;
    for (const problems::Setting& setting : model.settings) {
      CAPTURE(setting.name);
      CHECK(settings.insert(setting.name).second);
      CHECK(setting.low <= setting.value);
      CHECK(setting.value <= setting.high);
      CHECK_FALSE(setting.meaning.empty());
    }
    const Guess guess = instance.guess();
    CHECK(guess.unknowns.size() == instance.problem->size());
    const std::vector<std::string> names = instance.problem->parameter_names();
    REQUIRE(guess.parameters.size() == static_cast<Index>(names.size()));
    for (std::size_t i = 0; i < names.size(); ++i) {
      CAPTURE(names[i]);
      REQUIRE(settings.contains(names[i]));
      CHECK(guess.parameters(static_cast<Index>(i)) == instance.values[instance.position(names[i])]);
    }
    CHECK(solve(*instance.problem, guess).outcome == Correction::converged);
  }
  CHECK(problems::find_model("no such model") == nullptr);
}

TEST_CASE("Every dense model of the library has exact derivatives", "[library]") {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> number(0.1, 1.5);
  for (const problems::LibraryModel& model : problems::library()) {
    const Instance instance(model.name);
    if (instance.problem->sparse()) continue;
    CAPTURE(model.name);
    for (int i = 0; i < 5; ++i) {
      Vector u(instance.problem->size());
      Vector p(static_cast<Index>(instance.problem->parameter_names().size()));
      for (double& value : u) value = number(random);
      for (double& value : p) value = number(random);
      const DerivativeReport report = check_derivatives(*instance.problem, u, p, 0);
      INFO(report.where);
      CHECK(report.worst < 1e-8);  // differences of step 5e-5 are good to 1e-16/5e-5 and 5e-5^4
    }
  }
}

TEST_CASE("The stirred tank has its published Hopf points", "[library]") {
  // AUTO-07p, demo ab: 1.65042E-01, 1.46882E-01, 1.32538E-01
  const TraceOptions options = over("p1", 0, 0.3);
  SECTION("p2 = 14") {
    const Branch branch = Instance("ab", {{"p2", 14}}).trace(options);
    const auto hopf = of_type(branch, PointType::hopf);
    REQUIRE_FALSE(hopf.empty());
    check_points(*Instance("ab").problem, 0, {hopf[0]},
                 {{PointType::hopf, 0.165042045324, {0.405955372117, 1.420843802411}, 1.024756375405}});
  }
  SECTION("p2 = 15 and 16") {
    for (const auto& [p2, p1] : {std::pair(15.0, 0.146882475604), std::pair(16.0, 0.132538444269)}) {
      const auto hopf = of_type(Instance("ab", {{"p2", p2}}).trace(options), PointType::hopf);
      REQUIRE_FALSE(hopf.empty());
      check_points(*Instance("ab").problem, 0, {hopf[0]}, {{PointType::hopf, p1}});
    }
  }
}

TEST_CASE("The stirred tank at p2 = 17 has its published folds and Hopf points", "[library]") {
  // AUTO-07p, demo ab: 1.20866E-01, 1.21901E-01, 1.17015E-01, 2.17079E-01. On the branch u2 = B u1.
  const double B = 17.0 / 4;
  check_branch(Instance("ab", {{"p2", 17}}), over("p1", 0, 0.3),
               {{PointType::hopf, 0.120865719509, {0.322062481732, 1.368765547360}, 0.652063316188},
                {PointType::fold, 0.121901160811, {0.378732187482, B * 0.378732187482}},
                {PointType::fold, 0.117014750427, {0.621267812518, B * 0.621267812518}},
                {PointType::hopf, 0.217080509696, {}, 5.529449649982}});
}

TEST_CASE("The stirred tank's folds are those of the closed form at any heat of reaction", "[library]") {
  const double p2 = GENERATE(16.5, 20.0, 24.0, 40.0);
  const double B = p2 / 4;
  const Branch branch = Instance("ab", {{"p2", p2}}).trace(over("p1", 0, 0.3));
  const auto folds = of_type(branch, PointType::fold);
  REQUIRE(folds.size() == 2);
  for (const int side : {-1, 1}) {
    const double u1 = 0.5 + side * std::sqrt(0.25 - 1 / B);
    const BranchPoint& fold = folds[side < 0 ? 0 : 1];
    CHECK_THAT(fold.unknowns(0), WithinRel(u1, published_textbook));
    CHECK_THAT(fold.parameters(0), WithinRel(u1 / (1 - u1) * std::exp(-B * u1), published_textbook));
  }
}

TEST_CASE("The cusp's folds are where its discriminant vanishes", "[library]") {
  const double lambda = GENERATE(1.0, 3.0, 0.1);
  const double mu = 2 * std::pow(lambda / 3, 1.5);
  const double x = std::sqrt(lambda / 3);
  const Instance cusp("cusp", {{"lambda", lambda}});
  check_branch(cusp, over("mu", -2.5, 2.5), {{PointType::fold, mu, {-x}}, {PointType::fold, -mu, {x}}});
}

TEST_CASE("The enzyme's symmetric branch has its published folds and branch points", "[library]") {
  // AUTO-07p, demo enz: 34.3569, 34.2229, 22.1816, 18.8871
  const auto both = [](double s) { return std::vector<double>{s, s}; };
  check_branch(Instance("enz"), over("s0", 0, 40),
               {{PointType::fold, 34.356924998526, both(1.048361974182)},
                {PointType::branch_point, 34.222886544190, both(1.174173719128)},
                {PointType::branch_point, 22.181637926124, both(4.394472751983)},
                {PointType::fold, 18.887067657924, both(8.822200333433)}});
}

TEST_CASE("The enzyme's asymmetric branch is a loop through both branch points with four folds",
          "[library]") {
  // AUTO-07p, demo enz: 25.3727, 26.6221; the mirror images s1 <-> s2 are on the loop as well.
  const Instance enzyme("enz");
  const TraceOptions options = over("s0", 0, 40);
  const auto points = of_type(enzyme.trace(options), PointType::branch_point);
  REQUIRE(points.size() == 2);
  for (const BranchPoint& start : points) {
    const Branch loop = switched(enzyme, start, Eigen::Vector2d(1, -1), options);
    INFO(loop.explanation);
    CHECK(loop.stop == Stop::closed_loop);
    std::vector<BranchPoint> folds = of_type(loop, PointType::fold);
    std::erase_if(folds, [](const BranchPoint& fold) { return fold.unknowns(0) < fold.unknowns(1); });
    std::sort(folds.begin(), folds.end(),
              [](const BranchPoint& a, const BranchPoint& b) { return a.parameters(0) < b.parameters(0); });
    check_points(*enzyme.problem, 0, folds,
                 {{PointType::fold, 25.3727148381, {5.884079982224, 0.571738506069}},
                  {PointType::fold, 26.6220717700, {8.782806716865, 1.047955078278}}});
    CHECK(of_type(loop, PointType::fold).size() == 4);
    CHECK(of_type(loop, PointType::branch_point).size() == 1);  // the other one: it starts on the first
  }
}

TEST_CASE("The predator and its prey have their published points on three branches", "[library]") {
  // AUTO-07p, demo pp2: 0.6, 0.821904, 0.832929, 0.671594
  const Instance prey("pp2");
  const TraceOptions options = over("p", 0, 1);
  const Branch empty = prey.trace(options);
  REQUIRE(empty.complete());
  check_points(*prey.problem, 0, special_points(empty), {{PointType::branch_point, 0.6, {0, 0}}});

  const BranchPoint first = of_type(empty, PointType::branch_point)[0];
  const Branch alone = switched(prey, first, Eigen::Vector2d(1, 0), options);
  CHECK(alone.stop == Stop::left_range);
  CHECK_THAT(alone.points.back().unknowns(0),
             WithinRel(1.0, published_textbook));  // unfished prey fills its place
  const double meeting = 2.0 / 3 / (1 - std::exp(-5.0 / 3));
  check_points(*prey.problem, 0, special_points(alone),
               {{PointType::branch_point, meeting, {1.0 / 3, 0}},
                {PointType::fold, 0.832929322234, {0.41116156075, 0}}});

  const BranchPoint second = of_type(alone, PointType::branch_point)[0];
  const Branch together = switched(prey, second, Eigen::Vector2d(0, 1), options);
  CHECK(together.stop == Stop::left_range);
  CHECK_THAT(together.points.back().unknowns(1), WithinRel(2.0, published_textbook));
  const double period = 10.38916998420;
  check_points(*prey.problem, 0, special_points(together),
               {{PointType::hopf, 0.671593847479, {1.0 / 3, 0.365761536}, 2 * M_PI / period}});
}

TEST_CASE("The function of Freudenstein and Roth has its published folds and extrema", "[library]") {
  // ACM TOMS 9 (1983) 236, problem 1, to 7 digits; the rest by the cubics in x2.
  TraceOptions options = over("x3", -0.9, 1);
  options.extrema_of = {"x1"};
  const Instance function("freudenstein_roth");
  const Branch branch = function.trace(options);
  REQUIRE(branch.complete());
  check_points(*function.problem, 0, special_points(branch),
               {{PointType::fold, 0.5875873254, {20.4858578279, -0.8968052533}},
                {PointType::fold, -0.6863527575, {61.0203150116, 2.2301385866}}});
  const auto troughs = of_type(branch, PointType::trough);
  const auto peaks = of_type(branch, PointType::peak);
  REQUIRE(troughs.size() == 1);
  REQUIRE(peaks.size() == 1);
  const auto check_turn = [](const BranchPoint& point, double x1, double x2, double x3) {
    CHECK_THAT(point.unknowns(0), WithinRel(x1, published_textbook));
    CHECK_THAT(point.unknowns(1), WithinRel(x2, published_textbook));
    CHECK_THAT(point.parameters(0), WithinRel(x3, published_textbook));
  };
  check_turn(troughs[0], 14.2830912501, -1.7413768922, 0.2585778714);
  check_turn(peaks[0], 61.6693625811, 1.9838011346, -0.6638797422);
  const Vector end = branch.points.back().unknowns;
  CHECK_THAT(end(0), WithinRel(5.0, published_textbook));
  CHECK_THAT(end(1), WithinRel(4.0, published_textbook));
}

TEST_CASE("The extended Lorenz model has its published Hopf points and fold", "[library]") {
  // BifurcationKit.jl, test/hopf_codim_2/lorenz84.jl: all four within its intervals of bisection
  TraceOptions options = over("F", 3, 1);
  options.stop_after = {{PointType::hopf, 3, ""}};  // not far from where it comes back to F = 3
  check_branch(Instance("lorenz84"), options,
               {{PointType::fold, 1.546648372598, {1.3117855253, -0.0428749982, 0.1803893942, -0.157027585}},
                {PointType::hopf,
                 1.619657820943,
                 {1.2188295236, -0.0356764364, 0.1987094485, -0.2454217496},
                 0.2952868167},
                {PointType::hopf,
                 2.467222123113,
                 {1.1289637935, -0.0249699314, 0.2185896344, -0.5384503042},
                 0.72320592},
                {PointType::hopf,
                 2.859875412748,
                 {1.118508101, -0.023418638, 0.2210307654, -0.6253175858},
                 1.1715226467}});
}

namespace {

/// The curve of folds through a fold of the branch, in a second parameter.
Branch fold_curve(FoldProblem& folds, const BranchPoint& fold, const TraceOptions& options) {
  const BasePoint at{fold.unknowns, fold.parameters, 0, {}};
  REQUIRE(folds.adapt(at));
  Guess guess;
  folds.join(at, guess.unknowns, guess.parameters);
  return trace(folds, guess, options);
}

}  // namespace

TEST_CASE("The cusp's folds are a curve on 27 mu^2 = 4 lambda^3 with the cusp at its tip", "[library]") {
  const Instance cusp("cusp");
  const auto folds = of_type(cusp.trace(over("mu", -2, 2)), PointType::fold);
  REQUIRE(folds.size() == 2);
  FoldProblem problem(*cusp.problem, 0);
  const Branch curve = fold_curve(problem, folds[0], over("lambda", 1, -1));
  CHECK(curve.stop == Stop::left_range);
  for (const BranchPoint& point : curve.points) {
    const double mu = point.unknowns(1), lambda = point.parameters(0);
    CHECK_THAT(27 * mu * mu,
               WithinAbs(4 * lambda * lambda * lambda, 1e-9) ||
                   WithinRel(4 * lambda * lambda * lambda, 1e-9));  // 40 times the tolerance on F
  }
  const auto tips = of_type(curve, PointType::cusp);
  REQUIRE(tips.size() == 1);
  CHECK_THAT(tips[0].unknowns(0), WithinAbs(0, published_textbook));
  CHECK_THAT(tips[0].unknowns(1), WithinAbs(0, published_textbook));
  CHECK_THAT(tips[0].parameters(0), WithinAbs(0, published_textbook));
  CHECK_THAT(curve.points.back().unknowns(1), WithinRel(folds[1].parameters(0), published_textbook));
}

TEST_CASE("The extended Lorenz model's curve of folds has its published points of codimension two",
          "[library]") {
  // BifurcationKit.jl, test/hopf_codim_2/lorenz84.jl, as recomputed; the mirror image is T <-> -T, U <-> -U
  const double side = GENERATE(1.0, -1.0);
  const Instance lorenz("lorenz84");
  auto fold = of_type(lorenz.trace(over("F", 3, 1)), PointType::fold).at(0);
  fold.unknowns(3) *= side;
  fold.parameters(1) *= side;
  FoldProblem problem(*lorenz.problem, 0);
  TraceOptions options = over("T", side * 0.04, -side * 0.04);
  options.stop_after = {{PointType::zero_hopf, 2, ""}};
  const Branch curve = fold_curve(problem, fold, options);
  REQUIRE(curve.stop == Stop::requested);
  const auto takens = of_type(curve, PointType::bogdanov_takens);
  REQUIRE(takens.size() == 1);
  CHECK_THAT(takens[0].unknowns(4), WithinRel(1.446716701115, published_textbook));
  CHECK_THAT(takens[0].parameters(0), WithinRel(side * 0.020940169683, published_textbook));
  const auto hopf = of_type(curve, PointType::zero_hopf);
  REQUIRE(hopf.size() == 2);
  for (const std::size_t i : {0, 1}) {
    CHECK_THAT(hopf[i].unknowns(4), WithinRel(1.283419296138, published_textbook));
    CHECK_THAT(hopf[i].parameters(0),
               WithinRel((i == 0 ? side : -side) * 1.265408341e-4, published_textbook));
    CHECK_THAT(omega_of(hopf[i]), WithinRel(1.0990516362, published_textbook));
  }
}
