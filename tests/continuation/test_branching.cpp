// Branch switching, corners where pieces meet, closed loops, and solutions found by deflation.

#include <cmath>
#include <numbers>

#include "arcslip/continuation/events/corner.hpp"
#include "arcslip/continuation/path/all_solutions.hpp"
#include "arcslip/continuation/path/switching.hpp"
#include "arcslip/continuation/points/normal_form.hpp"
#include "catch.hpp"
#include "flow.hpp"
#include "scalar_problem.hpp"

using namespace arcslip;
using namespace arcslip::continuation;
using namespace arcslip::testing;

namespace {

/// x (lambda + a x - x^2) = 0: a pitchfork for a = 0, else transcritical with a fold of the other branch at
/// lambda = -a^2/4.
ScalarProblem pitchfork(double a = 0) {
  return {{"lambda"},
          [a](double x, const Vector& p) { return x * (p(0) + a * x - x * x); },
          [a](double x, const Vector& p) { return p(0) + 2 * a * x - 3 * x * x; },
          {[](double x, const Vector&) { return x; }}};
}

/// u^2 + p^2 = 1.
ScalarProblem circle() {
  return {{"p"},
          [](double u, const Vector& p) { return u * u + p(0) * p(0) - 1; },
          [](double u, const Vector&) { return 2 * u; },
          {[](double, const Vector& p) { return 2 * p(0); }}};
}

/// x (1 - lambda^2 - x^2) = 0, in which x stands for -x as well.
class Arch : public ScalarProblem {
 public:
  Arch()
      : ScalarProblem{{"lambda"},
                      [](double x, const Vector& p) { return x * (1 - p(0) * p(0) - x * x); },
                      [](double x, const Vector& p) { return 1 - p(0) * p(0) - 3 * x * x; },
                      {[](double x, const Vector& p) { return -2 * p(0) * x; }}} {}
  std::vector<Symmetry> symmetries() const override {
    SparseMatrix map(1, 1);
    map.insert(0, 0) = -1;
    return {{"turned over", map}};
  }
};

/// Four pieces meet at the origin: u = slope_r p in the regimes p < 0, p > 0 of both signs of u.
class Crossroads : public Problem {
 public:
  // one switch: 0 (u<0, p<0), 1 (u>0, p>0), 2 (u<0, p>0), 3 (u>0, p<0): u - p in the first two, u + 2p else
  Index size() const override { return 1; }
  std::vector<std::string> parameter_names() const override { return {"p"}; }
  bool evaluate(const Vector& u, const Vector& p, const Regime& regime,
                const Evaluation& out) const override {
    const double slope = regime[0] < 2 ? 1 : -2;
    if (out.residual != nullptr) (*out.residual)(0) = u(0) - slope * p(0);
    if (out.jacobian != nullptr) (*out.jacobian)(0, 0) = 1;
    if (out.parameter_jacobian != nullptr) (*out.parameter_jacobian)(0, 0) = -slope;
    return true;
  }
  Index switch_count() const override { return 1; }
  int border_count(const Regime& /*regime*/) const override { return 2; }
  double border(const Vector& u, const Vector& p, const Regime& regime, int border,
                Gradient* gradient) const override {
    const double sign_u = regime == 0 || regime == 2 ? 1 : -1;
    const double sign_p = regime == 0 || regime == 3 ? 1 : -1;
    if (gradient != nullptr) {
      gradient->unknowns(0) = border == 0 ? sign_u : 0;
      gradient->parameters(0) = border == 0 ? 0 : sign_p;
    }
    return border == 0 ? sign_u * u(0) : sign_p * p(0);
  }
  std::optional<Regime> regime_beyond(const Regime& regime, int border) const override {
    const int over_u[] = {3, 2, 1, 0};
    const int over_p[] = {2, 3, 0, 1};
    return border == 0 ? over_u[regime[0]] : over_p[regime[0]];
  }
};

}  // namespace

TEST_CASE("A pitchfork is found, classified, and left along all its ways") {
  const ScalarProblem problem = pitchfork();
  const Branch branch = trace(problem, {vector_of({0}), vector_of({-1})}, over("lambda", -1, 1));
  REQUIRE(branch.complete());
  const auto found = of_type(branch, PointType::branch_point);
  REQUIRE(found.size() == 1);
  CHECK_THAT(found[0].parameters(0), WithinAbs(0, 1e-10));
  const auto form = branch_point_form(problem, 0, {found[0].unknowns, found[0].parameters, 0, {}});
  REQUIRE(form);
  CHECK(form->kind == BranchPointKind::pitchfork);
  CHECK_THAT(form->cubic, WithinRel(1.0, 1e-8));  // lambda = x^2
  const std::vector<Guess> ways = other_ways(problem, "lambda", found[0]);
  REQUIRE(ways.size() == 2);
  for (const Guess& way : ways) {
    const Branch other = trace(problem, way, over("lambda", -1, 1));
    CHECK(other.stop == Stop::reached_end);
    const BranchPoint& last = other.points.back();
    CHECK_THAT(last.unknowns(0), WithinRel(way.direction(0) > 0 ? 1.0 : -1.0, 1e-9));
    CHECK(of_type(other, PointType::fold).empty());
  }
}

TEST_CASE("At a fold that is a branch point as well the other branch is left along its own direction") {
  // z^2 = lambda (1 + z) of complex z: real for lambda > 0, and two solutions side by side below
  const auto problem = make_flow(2, {"lambda"}, [](const auto& u, const auto& p, auto& f) {
    f[0] = u[0] * u[0] - u[1] * u[1] - p[0] * (1.0 + u[0]);
    f[1] = 2.0 * u[0] * u[1] - p[0] * u[1];
  });
  const Branch branch =
      trace(*problem, {Eigen::Vector2d(1.6180339887, 0), vector_of({1})}, over("lambda", 1, -1));
  const auto found = of_type(branch, PointType::branch_point);
  REQUIRE(found.size() == 1);
  CHECK_THAT(found[0].parameters(0), WithinAbs(0, 1e-10));
  const auto form = branch_point_form(*problem, 0, {found[0].unknowns, found[0].parameters, 0, {}});
  REQUIRE(form);
  CHECK(form->kind == BranchPointKind::hilltop);
  const std::vector<Guess> ways = other_ways(*problem, "lambda", found[0]);
  REQUIRE(ways.size() == 2);
  for (const Guess& way : ways) {
    CHECK(std::abs(way.direction(0)) < 1e-6 * std::abs(way.direction(1)));
    const Branch other = trace(*problem, way, over("lambda", 1, -1));
    CHECK(other.stop == Stop::reached_end);
    const Vector& last = other.points.back().unknowns;  // (-1 +- j sqrt 3)/2
    CHECK_THAT(last(0), WithinAbs(-0.5, 1e-9));
    CHECK_THAT(std::abs(last(1)), WithinRel(std::sqrt(0.75), 1e-9));
  }
}

TEST_CASE("What leaves a branch is traced without it, and each way once") {
  const ScalarProblem problem = pitchfork();
  const TraceOptions options = over("lambda", -1, 1);
  const Branch branch = trace(problem, {vector_of({0}), vector_of({-1})}, options);
  std::vector<BranchPoint> points = of_type(branch, PointType::branch_point);
  REQUIRE(points.size() == 1);
  points.push_back(points.front());  // met twice
  const std::vector<Branch> leaving = trace_leaving(problem, points, options);
  REQUIRE(leaving.size() == 2);
  for (const Branch& one : leaving) CHECK_THAT(std::abs(one.points.back().unknowns(0)), WithinRel(1.0, 1e-9));
  CHECK(leaving[0].points.back().unknowns(0) == -leaving[1].points.back().unknowns(0));
  CHECK(trace_leaving(problem, points, options, {.images = true}).size() == 1);
  CHECK(trace_leaving(problem, {branch.points.front()}, options).empty());
}

TEST_CASE("A branch that has a symmetry again ends where it would go on as its own image") {
  const Arch problem;
  const std::vector<Branch> all =
      trace_connected(problem, {vector_of({0}), vector_of({-2})}, over("lambda", -2, 2));
  REQUIRE(all.size() == 2);
  CHECK(all[0].stop == Stop::reached_end);
  CHECK(of_type(all[0], PointType::branch_point).size() == 2);
  CHECK(all[1].stop == Stop::own_image);
  CHECK(all[1].complete());
  CHECK_THAT(all[1].explanation, ContainsSubstring("\"turned over\""));
  const Vector& last = all[1].points.back().unknowns;
  CHECK_THAT(last(0), WithinAbs(0, 1e-6));
  CHECK_THAT(std::abs(all[1].points.back().parameters(0)), WithinAbs(1, 1e-9));
  const double side = all[1].points[all[1].points.size() / 2].unknowns(0);
  for (const BranchPoint& point : all[1].points) CHECK(point.unknowns(0) * side > -1e-9);
  // On its own it goes round.
  const Branch circle =
      trace(problem, other_ways(problem, "lambda", of_type(all[0], PointType::branch_point)[0])[0],
            over("lambda", -2, 2));
  CHECK(circle.stop == Stop::closed_loop);
}

TEST_CASE("What hangs together is the same from wherever it is begun") {
  const Arch problem;
  const TraceOptions options = over("lambda", -2, 2);
  const std::vector<std::vector<double>> starts{{0}, {0, 1}, {1, 0, -1}, {-1, 0}};
  for (const std::vector<double>& start : starts) {
    std::vector<Guess> solutions;
    for (const double u : start) solutions.push_back({vector_of({u}), vector_of({0})});
    const std::vector<Branch> all = trace_connected_through(problem, solutions, options);
    CAPTURE(start);
    REQUIRE(all.size() == 2);
    const Branch& line = all[all[0].stop == Stop::own_image ? 1 : 0];
    const Branch& circle = all[all[0].stop == Stop::own_image ? 0 : 1];
    CHECK(line.complete());
    CHECK(line.points.front().parameters(0) == -2);
    CHECK(line.points.back().parameters(0) == 2);
    CHECK(of_type(line, PointType::branch_point).size() == 2);
    CHECK(circle.complete());
    CHECK_THAT(circle.points.front().unknowns(0), WithinAbs(0, 1e-6));
    CHECK_THAT(circle.points.back().unknowns(0), WithinAbs(0, 1e-6));
  }
}

TEST_CASE("A branch that is begun on its fold is traced to both sides of it") {
  const ScalarProblem problem = circle();
  for (const double p : {-1.0, 1.0}) {
    const Branch branch = trace_both(problem, {vector_of({0}), vector_of({p})}, over("p", -1.5, 1.5));
    CHECK(branch.stop == Stop::closed_loop);
    const ScalarProblem bend{{"p"},
                             [&](double u, const Vector& q) { return q(0) - p + u * u; },
                             [](double u, const Vector&) { return 2 * u; },
                             {[](double, const Vector&) { return 1.0; }}};
    const Branch open = trace_both(bend, {vector_of({0}), vector_of({p})}, over("p", -1.5, 1.5));
    CHECK(open.points.front().unknowns(0) * open.points.back().unknowns(0) < 0);
    CHECK_THAT(open.points.front().parameters(0), WithinAbs(-1.5, 1e-12));
    CHECK_THAT(open.points.back().parameters(0), WithinAbs(-1.5, 1e-12));
  }
}

TEST_CASE("What hangs together is begun on a branch point, or on an end, as well") {
  const Arch problem;
  for (const double lambda : {-2.0, -1.0, 1.0, 2.0}) {
    CAPTURE(lambda);
    const std::vector<Branch> all =
        trace_connected_through(problem, {{vector_of({0}), vector_of({lambda})}}, over("lambda", -2, 2));
    REQUIRE(all.size() == 2);
    for (const Branch& one : all) CHECK(one.complete());
    CHECK(std::abs(all[0].points.front().parameters(0)) == 2);
    CHECK(all[0].points.back().parameters(0) == -all[0].points.front().parameters(0));
    CHECK(of_type(all[0], PointType::branch_point).size() == 2);
    CHECK(all[1].stop == Stop::own_image);
  }
}

TEST_CASE("It does not end where it meets its images alone") {
  const auto turn = [](double angle) {
    const Matrix map{{std::cos(angle), -std::sin(angle)}, {std::sin(angle), std::cos(angle)}};
    return SparseMatrix(map.sparseView());
  };
  const SparseMatrix mirror = Matrix{{1.0, 0.0}, {0.0, -1.0}}.sparseView();
  const double third = 2 * std::numbers::pi / 3;
  // Those of a triangle: a branch along its first axis goes on as none of its images.
  const std::vector<Symmetry> triangle{{"turn", turn(third)},
                                       {"turn back", turn(-third)},
                                       {"mirror", mirror},
                                       {"second mirror", turn(third) * mirror * turn(-third)}};
  const Vector scale = Vector::Ones(3);
  const Vector along = vector_of({.8, 0, -.6});
  OwnImage image(triangle, 1e-6);
  CHECK(image.take(vector_of({-.1, 0}), along, scale) == nullptr);
  CHECK(image.take(vector_of({0, 0}), along, scale) == nullptr);
  // A square's half turn makes it one, but not where the parameter does not turn back.
  for (const double rate : {0.0, .6}) {
    OwnImage square({{"half turn", turn(std::numbers::pi)}, {"mirror", mirror}}, 1e-6);
    const Vector tangent = vector_of({std::sqrt(1 - rate * rate), 0, rate});
    CHECK(square.take(vector_of({0, 0}), tangent, scale) == nullptr);  // never lost
    CHECK(square.take(vector_of({-.1, 0}), tangent, scale) == nullptr);
    const Symmetry* found = square.take(vector_of({1e-8, 0}), tangent, scale);
    CHECK((found != nullptr) == (rate == 0));
    if (found != nullptr) CHECK(found->name == "half turn");
  }
}

TEST_CASE("A transcritical point has two branches with their slopes") {
  const double a = 0.5;
  const ScalarProblem problem = pitchfork(a);
  const Branch branch = trace(problem, {vector_of({0}), vector_of({-1})}, over("lambda", -1, 1));
  const auto found = of_type(branch, PointType::branch_point);
  REQUIRE(found.size() == 1);
  const auto form = branch_point_form(problem, 0, {found[0].unknowns, found[0].parameters, 0, {}});
  REQUIRE(form);
  CHECK(form->kind == BranchPointKind::transcritical);
  CHECK_THAT(std::abs(form->slopes[1]), WithinRel(a, 1e-8));  // lambda = -a x
  const std::vector<Branch> all =
      trace_connected(problem, {vector_of({0}), vector_of({-1})}, over("lambda", -1, 1));
  REQUIRE(all.size() == 3);
  std::size_t folds = 0;
  for (const Branch& one : all) {
    for (const BranchPoint& fold : of_type(one, PointType::fold)) {
      ++folds;
      CHECK_THAT(fold.parameters(0), WithinRel(-a * a / 4, 1e-10));
      const auto coefficient = fold_form(problem, 0, {fold.unknowns, fold.parameters, 0, {}});
      REQUIRE(coefficient);
      CHECK_THAT(coefficient->quadratic, WithinRel(1.0, 1e-8));  // lambda = x^2 - a x
    }
  }
  CHECK(folds == 1);
}

TEST_CASE("A fold's quadratic coefficient is that of the curve") {
  // mu = x^2 (3 + x): at the fold x = 0 the coefficient is 3.
  const ScalarProblem problem(
      {"mu"}, [](double x, const Vector& p) { return x * x * (3 + x) - p(0); },
      [](double x, const Vector&) { return 6 * x + 3 * x * x; },
      {[](double, const Vector&) { return -1.0; }});
  const Branch branch = trace(problem, {vector_of({0.5}), vector_of({0.875})}, over("mu", 0.875, -1));
  const auto folds = of_type(branch, PointType::fold);
  REQUIRE(folds.size() >= 1);
  const auto form = fold_form(problem, 0, {folds[0].unknowns, folds[0].parameters, 0, {}});
  REQUIRE(form);
  CHECK_THAT(form->quadratic, WithinRel(3.0, 1e-8));
}

TEST_CASE("A closed loop is recognised where it closes, and traced once") {
  TraceOptions options = over("p", -2, 2);
  const Branch loop = trace_both(circle(), {vector_of({0.8}), vector_of({0.6})}, options);
  REQUIRE(loop.stop == Stop::closed_loop);
  CHECK(loop.complete());
  const auto folds = of_type(loop, PointType::fold);
  REQUIRE(folds.size() == 2);
  CHECK_THAT(std::abs(folds[0].parameters(0)), WithinRel(1.0, 1e-12));
  CHECK_THAT(folds[0].parameters(0) + folds[1].parameters(0), WithinAbs(0, 1e-10));
  CHECK_THAT(loop.points.back().unknowns(0), WithinRel(0.8, 1e-10));
  // arclength is a sum of chords: 2 pi from below, of order max_step^2
  CHECK_THAT(loop.points.back().arclength, WithinRel(2 * std::numbers::pi, 1e-3));
}

TEST_CASE("All solutions at a value are found by deflation, an isola's among them") {
  // (u^2 + p^2 - 1)(u - 3) = 0 at p = 0.5: the circle is connected to nothing.
  const ScalarProblem problem(
      {"p"}, [](double u, const Vector& p) { return (u * u + p(0) * p(0) - 1) * (u - 3); },
      [](double u, const Vector& p) { return 2 * u * (u - 3) + (u * u + p(0) * p(0) - 1); },
      {[](double u, const Vector& p) { return 2 * p(0) * (u - 3); }});
  SolveAllOptions options;
  options.lower = vector_of({-5});
  options.upper = vector_of({5});
  const std::vector<Guess> all = solve_all(problem, {{vector_of({3.2}), vector_of({0.5})}}, options);
  REQUIRE(all.size() == 3);
  std::vector<double> values;
  for (const Guess& one : all) values.push_back(one.unknowns(0));
  std::sort(values.begin(), values.end());
  CHECK_THAT(values[0], WithinRel(-std::sqrt(0.75), 1e-12));
  CHECK_THAT(values[1], WithinRel(std::sqrt(0.75), 1e-12));
  CHECK_THAT(values[2], WithinRel(3.0, 1e-12));
  const Branch isola = trace_both(problem, {vector_of({values[1]}), vector_of({0.5})}, over("p", -2, 2));
  CHECK(isola.stop == Stop::closed_loop);
  const std::vector<Guess> again = solve_all(problem, {{vector_of({3.2}), vector_of({0.5})}}, options);
  REQUIRE(again.size() == 3);
  for (std::size_t i = 0; i < 3; ++i) CHECK(again[i].unknowns == all[i].unknowns);
}

TEST_CASE("Several solutions of one problem come from a single guess") {
  // Four: (+-1, +-2) of x^2 = 1, y^2 = 4, by deflation from one start.
  class Square : public Problem {
   public:
    Index size() const override { return 2; }
    std::vector<std::string> parameter_names() const override { return {"p"}; }
    bool evaluate(const Vector& u, const Vector& p, const Regime& /*regime*/,
                  const Evaluation& out) const override {
      if (out.residual != nullptr) *out.residual << u(0) * u(0) - p(0), u(1) * u(1) - 4 * p(0);
      if (out.jacobian != nullptr) *out.jacobian << 2 * u(0), 0, 0, 2 * u(1);
      if (out.parameter_jacobian != nullptr) *out.parameter_jacobian << -1, -4;
      return true;
    }
  };
  const std::vector<Guess> all = solve_all(Square(), {{vector_of({0.7, 1.1}), vector_of({1})}});
  REQUIRE(all.size() == 4);
  for (const Guess& one : all) {
    CHECK_THAT(std::abs(one.unknowns(0)), WithinRel(1.0, 1e-12));
    CHECK_THAT(std::abs(one.unknowns(1)), WithinRel(2.0, 1e-12));
  }
}

TEST_CASE("At a corner of several regimes all pieces that leave are found and can be followed") {
  const Crossroads problem;
  const std::vector<Guess> pieces = leaving_pieces(problem, 0, {vector_of({0}), vector_of({0}), 0, {}});
  REQUIRE(pieces.size() == 4);
  for (const Guess& piece : pieces) {
    const double slope = piece.regime[0] < 2 ? 1 : -2;
    CHECK_THAT(piece.direction(0) / piece.direction(1), WithinRel(slope, 1e-10));
    const Branch branch = trace(problem, piece, over("p", -1, 1));
    CHECK(branch.complete());
    CHECK_THAT(branch.points.back().unknowns(0),
               WithinRel(slope * branch.points.back().parameters(0), 1e-10));
  }
  const std::vector<Branch> all =
      trace_connected(problem, {vector_of({-1}), vector_of({-1})}, over("p", -1, 1));
  CHECK(all.size() == 3);  // the straight one, and the two ways of the other
}
