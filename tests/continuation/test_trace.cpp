// The engine on problems without physics, each with its answer in closed form.

#include <cmath>

#include "arcslip/continuation/path/trace.hpp"
#include "arcslip/continuation/problem/derivative_check.hpp"
#include "branches.hpp"
#include "catch.hpp"
#include "engine_problems.hpp"
#include "scalar_problem.hpp"

using namespace arcslip;
using namespace arcslip::continuation;
using namespace arcslip::testing;

namespace {

Guess guess_of(std::initializer_list<double> unknowns, double parameter, const Regime& regime = {}) {
  Guess guess{Vector(static_cast<Index>(unknowns.size())), Vector::Constant(1, parameter), regime};
  std::copy(unknowns.begin(), unknowns.end(), guess.unknowns.begin());
  return guess;
}

/// The branch turns back once, at p = 0, and leaves its range where it came in, at u = `end`.
void check_turned(const Branch& branch, PointType type, double error, double end, double error_of_end) {
  CHECK(branch.stop == Stop::left_range);
  const auto folds = of_type(branch, type);
  REQUIRE(folds.size() == 1);
  CHECK_THAT(folds[0].parameters(0), WithinAbs(0, error));
  CHECK_THAT(branch.points.back().unknowns(0), WithinRel(end, error_of_end));
}

}  // namespace

TEST_CASE("The branch passes both folds of the cusp and lands exactly on its last value") {
  const Branch branch = trace(Cusp(), guess_of({-1.5}, -2), over("mu", -2, 2));
  REQUIRE(branch.complete());
  CHECK(branch.points.front().type == PointType::start);
  CHECK(branch.points.front().parameters(0) == -2);
  CHECK(branch.points.back().type == PointType::end);
  CHECK(branch.points.back().parameters(0) == 2);
  const auto folds = of_type(branch, PointType::fold);
  REQUIRE(folds.size() == 2);
  const double mu = 2 / (3 * std::sqrt(3.0));
  CHECK_THAT(folds[0].parameters(0), WithinRel(mu, 1e-12));
  CHECK_THAT(folds[0].unknowns(0), WithinRel(-1 / std::sqrt(3.0), 1e-10));
  CHECK_THAT(folds[1].parameters(0), WithinRel(-mu, 1e-12));
  CHECK_THAT(folds[1].unknowns(0), WithinRel(1 / std::sqrt(3.0), 1e-10));
  for (const BranchPoint& point : branch.points) CHECK(point.residual <= 1e-9);
}

TEST_CASE("The same branch the other way has the same folds") {
  const Branch branch = trace(Cusp(), guess_of({1.5}, 2), over("mu", 2, -2));
  REQUIRE(branch.complete());
  const auto folds = of_type(branch, PointType::fold);
  REQUIRE(folds.size() == 2);
  CHECK_THAT(folds[0].unknowns(0), WithinRel(1 / std::sqrt(3.0), 1e-10));
  CHECK_THAT(folds[1].unknowns(0), WithinRel(-1 / std::sqrt(3.0), 1e-10));
}

TEST_CASE("A branch whose start is a fold on its first value, but for rounding, does not leave its range") {
  for (int i = 0; i <= 24; ++i) {
    const double fold = 200 * (1 + (i == 0 ? 0 : 1e-9 * std::pow(10, -0.25 * (i - 1))));
    const ScalarProblem problem(
        {"p"}, [=](double u, const Vector& p) { return u * u + p(0) / fold - 1; },
        [](double u, const Vector&) { return 2 * u; }, {[=](double, const Vector&) { return 1 / fold; }});
    for (const bool towards_to : {true, false}) {
      const Branch branch = trace_one_way(problem, guess_of({0}, 200), towards_to, over("p", 200, 500));
      CAPTURE(i, branch.explanation);
      CHECK(branch.stop == Stop::left_range);
      for (const BranchPoint& point : branch.points) CHECK(point.parameters(0) >= 200 * (1 - 1e-10));
    }
  }
}

TEST_CASE("A branch that turns back to its first value ends there and says so") {
  const Branch branch = trace(Cusp(), guess_of({-1}, 0), over("mu", 0, 1.5));
  CHECK(branch.stop == Stop::left_range);
  CHECK(branch.points.back().parameters(0) == 0);
  CHECK_THAT(branch.points.back().unknowns(0), WithinAbs(0, 1e-10));  // the middle sheet
}

TEST_CASE("A branch that ends just before a fold does not end behind it") {
  const double fold = 2 / (3 * std::sqrt(3.0));
  const double gap = GENERATE(1e-2, 1e-4, 1e-7);
  const Branch branch = trace(Cusp(), guess_of({-1.5}, -2), over("mu", -2, fold - gap));
  REQUIRE(branch.complete());
  CHECK(branch.points.back().parameters(0) == fold - gap);
  CHECK(branch.points.back().unknowns(0) < -1 / std::sqrt(3.0));
  CHECK(of_type(branch, PointType::fold).empty());
}

TEST_CASE("Freudenstein and Roth's branch has its published folds") {
  const Branch branch = trace(FreudensteinRoth(), guess_of({22.8, -2.59}, -0.9), over("x3", -0.9, 1));
  REQUIRE(branch.complete());
  const auto folds = of_type(branch, PointType::fold);
  REQUIRE(folds.size() == 2);
  CHECK_THAT(folds[0].unknowns(0), WithinRel(20.4858578279, 1e-10));
  CHECK_THAT(folds[0].unknowns(1), WithinRel(-0.8968052533, 1e-9));
  CHECK_THAT(folds[0].parameters(0), WithinRel(0.5875873254, 1e-9));
  CHECK_THAT(folds[1].unknowns(0), WithinRel(61.0203150116, 1e-10));
  CHECK_THAT(folds[1].unknowns(1), WithinRel(2.2301385866, 1e-9));
  CHECK_THAT(folds[1].parameters(0), WithinRel(-0.6863527575, 1e-9));
  CHECK_THAT(branch.points.back().unknowns(0), WithinRel(5.0, 1e-9));
  CHECK_THAT(branch.points.back().unknowns(1), WithinRel(4.0, 1e-9));
}

TEST_CASE("A change of units changes neither the branch nor its folds") {
  const Branch plain = trace(FreudensteinRoth(), guess_of({15, -2}, 0), over("x3", 0, 1));
  const Branch scaled = trace(Rescaled(1e6, 1e6), guess_of({15e6, -2e6}, 0), over("x3", 0, 1));
  REQUIRE(scaled.points.size() == plain.points.size());
  for (std::size_t i = 0; i < plain.points.size(); ++i) {
    CHECK(scaled.points[i].type == plain.points[i].type);
    CHECK_THAT(scaled.points[i].unknowns(0) / 1e6, WithinRel(plain.points[i].unknowns(0), 1e-8));
  }
}

TEST_CASE("The discretised Bratu problem folds at a parameter that converges to 3.51383071912516") {
  // Error of second-order differences: c h^2 with c fitted at two meshes, so that extrapolation gains two
  // digits.
  const auto fold = [](Index m) {
    TraceOptions options = over("L", 0, 4);
    options.max_step = 0.3;
    const Branch branch = trace(Bratu(m), {Vector::Zero(m), Vector::Zero(1), 0}, options);
    const auto folds = of_type(branch, PointType::fold);
    REQUIRE(folds.size() == 1);
    return folds[0].parameters(0);
  };
  const double coarse = fold(15);
  const double fine = fold(31);
  CHECK_THAT((4 * fine - coarse) / 3, WithinRel(3.51383071912516, 1e-5));
  CHECK_THAT(fine, WithinRel(3.51383071912516, 2e-3));
}

TEST_CASE("Needles of any sharpness are passed with the defaults, and their peak is found") {
  const double width = GENERATE(1e-1, 1e-3, 1e-6, 1e-9);
  TraceOptions options = over("p", 0.1, 10);
  options.extrema_of = {"amplitude"};
  const Needle problem(width);
  const double start = -0.5 * std::log1p(0.81 / (width * width));
  const Branch branch = trace(problem, guess_of({start}, 0.1), options);
  REQUIRE(branch.complete());
  const auto peaks = of_type(branch, PointType::peak);
  REQUIRE(peaks.size() == 1);
  CHECK_THAT(peaks[0].parameters(0), WithinRel(1.0, 1e-14));
  CHECK_THAT(peaks[0].unknowns(0), WithinAbs(0, 1e-10));
  CHECK(of_type(branch, PointType::trough).empty());
  CHECK(of_type(branch, PointType::fold).empty());
  CHECK(branch.points.size() < 700);
  for (std::size_t i = 1; i < branch.points.size(); ++i) {
    CHECK(branch.points[i].parameters(0) > branch.points[i - 1].parameters(0));  // never lapped
  }
}

TEST_CASE("A corner of any angle is turned at the border itself") {
  const double slope = GENERATE(1e-4, 0.02, 1.0, 50.0, 1e4);
  const double to = std::min(1.0, 10 * slope);
  const Branch branch = trace(Corner(1, slope), guess_of({-1}, -1), over("p", -1, to));
  REQUIRE(branch.complete());
  const auto switches = of_type(branch, PointType::regime_switch);
  REQUIRE(switches.size() == 1);
  CHECK_THAT(switches[0].unknowns(0), WithinAbs(0, 1e-14));
  CHECK_THAT(switches[0].parameters(0), WithinAbs(0, 1e-14));
  CHECK(switches[0].regime == 1);
  CHECK_THAT(branch.points.back().unknowns(0), WithinRel(to / slope, 1e-9));
  CHECK(of_type(branch, PointType::fold).empty());
}

TEST_CASE("A corner at which the parameter turns back is a fold of its own kind") {
  const Branch branch = trace(Corner(1, -2), guess_of({-1}, -1), over("p", -1, 1));
  CHECK(of_type(branch, PointType::fold).empty());
  check_turned(branch, PointType::corner_fold, 1e-14, 0.5, 1e-10);
}

TEST_CASE("A corner of less than a right angle within a regime is passed") {
  const double slope = GENERATE(0.05, 0.2, 5.0, 100.0);
  const Branch branch = trace(HiddenCorner(1, slope), guess_of({-1}, -1), over("p", -1, slope));
  REQUIRE(branch.complete());
  CHECK_THAT(branch.points.back().unknowns(0), WithinRel(1, 1e-9));
  CHECK(of_type(branch, PointType::fold).empty());
}

TEST_CASE("A corner within a regime at which the parameter turns back is a fold") {
  const double slope = GENERATE(-0.05, -0.5, -0.9);
  const Branch branch = trace(HiddenCorner(1, slope), guess_of({-1}, -1), over("p", -1, 1));
  check_turned(branch, PointType::fold, 1e-12, -1 / slope, 1e-9);
}

TEST_CASE("A corner within a regime is turned, too, where the branch comes back beside itself") {
  const double slope = GENERATE(-1.1, -2.0, -20.0);
  const Branch branch = trace(HiddenCorner(1, slope), guess_of({-1}, -1), over("p", -1, 1));
  check_turned(branch, PointType::corner_fold, 1e-8, -1 / slope, 1e-9);
}

TEST_CASE("A border touched only between two steps is not stepped over") {
  const double width = GENERATE(0.3, 1e-2, 1e-3, 1e-4);  // the border function rises to width^2
  const Branch branch = trace(Bump(width), guess_of({-1}, 0), over("p", 0, 2));
  REQUIRE(branch.complete());
  const auto switches = of_type(branch, PointType::regime_switch);
  REQUIRE(switches.size() == 2);
  CHECK_THAT(switches[0].parameters(0), WithinAbs(1 - width, 1e-10));
  CHECK_THAT(switches[1].parameters(0), WithinAbs(1 + width, 1e-10));
}

TEST_CASE("Listed values are landed on exactly, in either direction") {
  TraceOptions options = over("mu", 3, 1);
  options.stop_at = {1.25, 2.7, 2.5};
  const Branch branch = trace(Cusp(), guess_of({1.6}, 3), options);
  const auto users = of_type(branch, PointType::user);
  REQUIRE(users.size() == 3);
  CHECK(users[0].parameters(0) == 2.7);
  CHECK(users[1].parameters(0) == 2.5);
  CHECK(users[2].parameters(0) == 1.25);
}

TEST_CASE("Each end of a branch has its reason") {
  TraceOptions options = over("mu", -2, 2);
  options.max_points = 7;
  const Branch full = trace(Cusp(), guess_of({-1.5}, -2), options);
  CHECK(full.stop == Stop::max_points);
  CHECK(full.points.size() == 7);

  int seen = 0;
  const Branch stopped =
      trace(Cusp(), guess_of({-1.5}, -2), over("mu", -2, 2), [&](const BranchPoint&) { return ++seen < 5; });
  CHECK(stopped.stop == Stop::interrupted);
  CHECK(stopped.points.size() == 5);

  class NoSolution : public Cusp {
   public:
    bool evaluate(const Vector&, const Vector&, const Regime&, const Evaluation&) const override {
      return false;
    }
  };
  const Branch none = trace(NoSolution(), guess_of({0}, 0), over("mu", 0, 1));
  CHECK(none.stop == Stop::no_start);
  CHECK(none.points.empty());

  class Wall : public Cusp {  // cannot be evaluated beyond mu = 1
   public:
    bool evaluate(const Vector& u, const Vector& p, const Regime& regime,
                  const Evaluation& out) const override {
      return p(0) <= 1 && Cusp::evaluate(u, p, regime, out);
    }
  };
  const Branch wall = trace(Wall(), guess_of({1.2}, 0.5), over("mu", 0.5, 2));
  CHECK(wall.stop == Stop::no_value);
  CHECK_THAT(wall.points.back().parameters(0), WithinAbs(1, 1e-8));
  CHECK_THAT(wall.explanation, ContainsSubstring("min_step"));

  class Broken : public Cusp {  // nan beyond mu = 1
   public:
    bool evaluate(const Vector& u, const Vector& p, const Regime& regime,
                  const Evaluation& out) const override {
      Cusp::evaluate(u, p, regime, out);
      if (p(0) > 1 && out.residual != nullptr) (*out.residual)(0) = std::nan("");
      return true;
    }
  };
  const Branch broken = trace(Broken(), guess_of({1.2}, 0.5), over("mu", 0.5, 2));
  CHECK(broken.stop == Stop::no_value);
  for (const BranchPoint& point : broken.points) CHECK(std::isfinite(point.unknowns(0)));
}

TEST_CASE("A start outside its regime is refused") {
  const Branch branch = trace(Corner(1, 1), guess_of({0.5}, 0.5, 0), over("p", 0.5, 1));
  CHECK(branch.stop == Stop::no_start);
  CHECK_THAT(branch.explanation, ContainsSubstring("below"));
}

TEST_CASE("Options that do not fit are refused with what is allowed") {
  const Guess guess = guess_of({-1.5}, -2);
  CHECK_THROWS_WITH(trace(Cusp(), guess, over("nu", -2, 2)), ContainsSubstring("mu"));
  CHECK_THROWS_AS(trace(Cusp(), guess, over("mu", 1, 1)), std::invalid_argument);
  TraceOptions outside = over("mu", -2, 2);
  outside.stop_at = {3};
  CHECK_THROWS_WITH(trace(Cusp(), guess, outside), ContainsSubstring("stop_at"));
  TraceOptions unknown = over("mu", -2, 2);
  unknown.extrema_of = {"Y"};
  CHECK_THROWS_AS(trace(Cusp(), guess, unknown), std::invalid_argument);
}

TEST_CASE("The derivative checker passes exact derivatives and names a wrong one") {
  Vector u(2);
  u << 3.0, -1.0;
  CHECK(check_derivatives(FreudensteinRoth(), u, Vector::Zero(1), 0).worst < 1e-9);

  class Wrong : public FreudensteinRoth {
   public:
    bool evaluate(const Vector& u, const Vector& p, const Regime& regime,
                  const Evaluation& out) const override {
      FreudensteinRoth::evaluate(u, p, regime, out);
      if (out.jacobian != nullptr) (*out.jacobian)(1, 0) *= 1.01;
      return true;
    }
  };
  const DerivativeReport report = check_derivatives(Wrong(), u, Vector::Zero(1), 0);
  CHECK(report.worst > 1e-3);
  CHECK(report.where == "dF1/du0");
}

TEST_CASE("Points of a branch lie no farther apart than max_step, but for the corrector's last bit") {
  TraceOptions options = over("mu", -2, 2);
  options.max_step = 0.03;
  const Branch branch = trace(Cusp(), guess_of({-1.5}, -2), options);
  REQUIRE(branch.complete());
  for (std::size_t i = 1; i < branch.points.size(); ++i) {
    CHECK(branch.points[i].arclength - branch.points[i - 1].arclength <= 1.15 * 0.03);
  }
}

TEST_CASE("A branch that has all that was asked for says so, told to end there or not") {
  TraceOptions options = over("mu", -2, 2);
  options.stop_after = {{PointType::fold, 1, {}}};
  const Branch branch = trace(Cusp(), guess_of({-1.5}, -2), options,
                              [](const BranchPoint& point) { return point.type != PointType::fold; });
  CHECK(branch.stop == Stop::requested);
  CHECK(branch.points.back().type == PointType::fold);
}
