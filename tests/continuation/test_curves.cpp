// Curves of special points in two parameters, against closed forms.

#include "arcslip/continuation/curves/curve.hpp"

#include <cmath>

#include "arcslip/continuation/points/border_problem.hpp"
#include "arcslip/continuation/points/fold_problem.hpp"
#include "catch.hpp"
#include "engine_problems.hpp"
#include "scalar_problem.hpp"

using namespace arcslip;
using namespace arcslip::continuation;
using namespace arcslip::testing;

namespace {

/// x' = mu + lambda x - x^3.
ScalarProblem cusp_surface() {
  return {{"mu", "lambda"},
          [](double x, const Vector& p) { return p(0) + p(1) * x - x * x * x; },
          [](double x, const Vector& p) { return p(1) - 3 * x * x; },
          {[](double, const Vector&) { return 1.0; }, [](double x, const Vector&) { return x; }}};
}

/// The Bogdanov-Takens normal form x' = y, y' = b1 + b2 x + x^2 - x y [Kuznetsov 2004, section 8.4]: folds at
/// b1 = b2^2/4, Hopf points at b1 = 0, b2 < 0 with omega^2 = -b2.
class BogdanovTakens : public Problem {
 public:
  Index size() const override { return 2; }
  std::vector<std::string> parameter_names() const override { return {"b1", "b2"}; }
  bool is_equilibrium() const override { return true; }
  bool evaluate(const Vector& u, const Vector& p, const Regime& /*regime*/,
                const Evaluation& out) const override {
    const double x = u(0), y = u(1);
    if (out.residual != nullptr) *out.residual << y, p(0) + p(1) * x + x * x - x * y;
    if (out.jacobian != nullptr) *out.jacobian << 0, 1, p(1) + 2 * x - y, -x;
    if (out.parameter_jacobian != nullptr) *out.parameter_jacobian << 0, 0, 1, x;
    return true;
  }
};

/// Two oscillators at rest, u' = A u, with the eigenvalues p +- i and p + q - 1 +- 2i.
class TwoOscillators : public Problem {
 public:
  Index size() const override { return 4; }
  std::vector<std::string> parameter_names() const override { return {"p", "q"}; }
  bool is_equilibrium() const override { return true; }
  bool evaluate(const Vector& u, const Vector& p, const Regime& /*regime*/,
                const Evaluation& out) const override {
    const double a = p(0), b = p(0) + p(1) - 1;
    Matrix matrix = Matrix::Zero(4, 4);
    matrix.topLeftCorner(2, 2) << a, -1, 1, a;
    matrix.bottomRightCorner(2, 2) << b, -2, 2, b;
    if (out.residual != nullptr) *out.residual = matrix * u;
    if (out.jacobian != nullptr) *out.jacobian = matrix;
    if (out.parameter_jacobian != nullptr) {
      out.parameter_jacobian->setZero();
      out.parameter_jacobian->col(0) = u;
      out.parameter_jacobian->col(1).tail(2) = u.tail(2);
    }
    return true;
  }
};

/// u = p - q^2 with a border at u = 0.
class Parabola : public Corner {
 public:
  Parabola() : Corner(1, 1) {}
  std::vector<std::string> parameter_names() const override { return {"p", "q"}; }
  bool evaluate(const Vector& u, const Vector& p, const Regime& /*regime*/,
                const Evaluation& out) const override {
    if (out.residual != nullptr) (*out.residual)(0) = u(0) - p(0) + p(1) * p(1);
    if (out.jacobian != nullptr) (*out.jacobian)(0, 0) = 1;
    if (out.parameter_jacobian != nullptr) *out.parameter_jacobian << -1, 2 * p(1);
    return true;
  }
};

/// The points of a curve as points of the base.
std::vector<BasePoint> base_points(const ExtendedProblem& problem, const Branch& curve) {
  std::vector<BasePoint> points;
  for (const BranchPoint& point : curve.points)
    points.push_back(problem.split(point.unknowns, point.parameters, point.regime));
  return points;
}

}  // namespace

TEST_CASE("The fold curve of the cusp is 27 mu^2 = 4 lambda^3 with the cusp at its tip") {
  const ScalarProblem problem = cusp_surface();
  const Branch branch = trace(problem, {vector_of({-1.5}), vector_of({-2, 1})}, over("mu", -2, 2));
  const auto folds = of_type(branch, PointType::fold);
  REQUIRE(folds.size() == 2);
  const CurveStart start = curve_through(problem, "mu", folds[0]);
  const Branch curve = trace_curve(*start.problem, start.point, over("lambda", -1, 3));
  REQUIRE(curve.complete());
  // Both arms end at lambda = 3, where mu = -+2 and |x| = 1.
  CHECK(curve.points.front().parameters(0) == 3);
  CHECK(curve.points.back().parameters(0) == 3);
  for (const BasePoint& point : base_points(*start.problem, curve)) {
    const double mu = point.parameters(0), lambda = point.parameters(1);
    CHECK_THAT(27 * mu * mu, WithinAbs(4 * lambda * lambda * lambda, 1e-9) ||
                                 WithinRel(4 * lambda * lambda * lambda, 1e-9));
    CHECK_THAT(3 * point.unknowns(0) * point.unknowns(0), WithinAbs(lambda, 1e-9));
  }
  const auto cusps = of_type(curve, PointType::cusp);
  REQUIRE(cusps.size() == 1);
  const BasePoint cusp = start.problem->split(cusps[0].unknowns, cusps[0].parameters, 0);
  CHECK_THAT(cusp.parameters(0), WithinAbs(0, 1e-10));
  CHECK_THAT(cusp.parameters(1), WithinAbs(0, 1e-10));
  CHECK(of_type(curve, PointType::fold).empty());
  const BasePoint end = start.problem->split(curve.points.back().unknowns, curve.points.back().parameters, 0);
  CHECK_THAT(std::abs(end.parameters(0)), WithinRel(2.0, 1e-10));
  CHECK_THAT(std::abs(end.unknowns(0)), WithinRel(1.0, 1e-10));
}

TEST_CASE("A curve ends on the edge of its window in the active parameter") {
  const ScalarProblem problem = cusp_surface();
  FoldProblem folds(problem, 0);
  const BasePoint start{vector_of({1}), vector_of({-2, 3}), 0, {}};
  const Branch curve = trace_curve(folds, start, over("lambda", -1, 20), {-2.5, 1});
  REQUIRE(curve.complete());
  CHECK_THAT(curve.points.front().unknowns(1), WithinAbs(1, 1e-10));
  CHECK_THAT(curve.points.back().unknowns(1), WithinAbs(-2.5, 1e-10));
  CHECK(curve.points.back().type == PointType::end);
  CHECK_THAT(curve.explanation, ContainsSubstring("mu"));
  CHECK(of_type(curve, PointType::cusp).size() == 1);

  // Both arms come to a corner: mu = -+2 at lambda = 3.
  FoldProblem same(problem, 0);
  const BasePoint within{vector_of({0.5}), vector_of({-0.25, 0.75}), 0, {}};
  const Branch cut = trace_curve(same, within, over("lambda", -1, 3), {-2, 2});
  CHECK(cut.complete());
  CHECK(of_type(cut, PointType::event).empty());
  CHECK(of_type(cut, PointType::end).size() == 2);
}

TEST_CASE("A curve may start on an extremum of the active parameter, and on the edge of its range") {
  const ScalarProblem problem{
      {"p", "q"},
      [](double u, const Vector& p) { return p(0) - std::pow(p(1) - 0.3, 2) + u * u; },
      [](double u, const Vector&) { return 2 * u; },
      {[](double, const Vector&) { return 1.0; }, [](double, const Vector& p) { return 0.6 - 2 * p(1); }}};
  const auto traced = [&](double from, double at) {
    FoldProblem folds(problem, 0);  // at p = (q - 0.3)^2
    TraceOptions options = over("q", from, 1);
    options.extrema_of = {"p"};
    return trace_curve(folds, {vector_of({0}), vector_of({0, at}), 0, {}}, options);
  };
  const double beside = 0.3 - 5e-14;
  const Branch from_edge = traced(beside, beside);
  CHECK(from_edge.complete());
  CHECK(from_edge.points.front().type == PointType::start);
  CHECK(from_edge.points.back().parameters(0) == 1);
  CHECK(of_type(from_edge, PointType::trough).size() == 1);

  const Branch across = traced(-1, 0.3);
  CHECK(across.complete());
  CHECK(across.points.front().parameters(0) == -1);
  const auto troughs = of_type(across, PointType::trough);
  REQUIRE(troughs.size() == 1);
  CHECK(troughs[0].parameters(0) == 0.3);
  CHECK(of_type(across, PointType::peak).empty());
}

TEST_CASE("Folds and Hopf points of the Bogdanov-Takens normal form meet where they must") {
  const BogdanovTakens problem;
  const Branch branch = trace(problem, {vector_of({-0.8, 0}), vector_of({-1, -1})}, over("b1", -1, 1));
  const auto hopfs = of_type(branch, PointType::hopf);
  const auto folds = of_type(branch, PointType::fold);
  REQUIRE(hopfs.size() == 1);
  REQUIRE(folds.size() == 1);
  CHECK_THAT(hopfs[0].parameters(0), WithinAbs(0, 1e-10));
  CHECK_THAT(folds[0].parameters(0), WithinRel(0.25, 1e-10));

  const CurveStart hopf = curve_through(problem, "b1", hopfs[0]);
  const Branch hopf_curve = trace_curve(*hopf.problem, hopf.point, over("b2", -4, 2));
  REQUIRE(hopf_curve.complete());
  for (const BasePoint& point : base_points(*hopf.problem, hopf_curve)) {
    CHECK_THAT(point.parameters(0), WithinAbs(0, 1e-9));
    CHECK_THAT(point.extras(0), WithinAbs(-point.parameters(1), 1e-9));  // omega^2 = -b2
  }
  const auto on_hopf = of_type(hopf_curve, PointType::bogdanov_takens);
  REQUIRE(on_hopf.size() == 1);
  CHECK_THAT(on_hopf[0].parameters(0), WithinAbs(0, 1e-10));

  const CurveStart fold = curve_through(problem, "b1", folds[0]);
  const Branch fold_curve = trace_curve(*fold.problem, fold.point, over("b2", -4, 2));
  REQUIRE(fold_curve.complete());
  for (const BasePoint& point : base_points(*fold.problem, fold_curve))
    CHECK_THAT(point.parameters(0), WithinAbs(0.25 * point.parameters(1) * point.parameters(1), 1e-9));
  const auto on_fold = of_type(fold_curve, PointType::bogdanov_takens);
  REQUIRE(on_fold.size() == 1);
  CHECK_THAT(on_fold[0].parameters(0), WithinAbs(0, 1e-10));
  CHECK(of_type(fold_curve, PointType::cusp).empty());
}

TEST_CASE("On a curve of Hopf points the crossing of a second pair is found") {
  const TwoOscillators problem;
  const Branch branch = trace(problem, {Vector::Zero(4), vector_of({-1, 0})}, over("p", -1, 2));
  const auto hopfs = of_type(branch, PointType::hopf);
  REQUIRE(hopfs.size() == 2);
  CHECK_THAT(hopfs[0].parameters(0), WithinAbs(0, 1e-10));
  CHECK_THAT(hopfs[1].parameters(0), WithinAbs(1, 1e-10));
  CHECK(branch.points.front().unstable == 0);
  CHECK(branch.points.back().unstable == 4);
  const CurveStart start = curve_through(problem, "p", hopfs[0]);
  const Branch curve = trace_curve(*start.problem, start.point, over("q", 0, 3));
  REQUIRE(curve.complete());
  const auto both = of_type(curve, PointType::hopf_hopf);
  REQUIRE(both.size() == 1);
  CHECK_THAT(both[0].parameters(0), WithinAbs(1, 1e-10));
  for (const BasePoint& point : base_points(*start.problem, curve))
    CHECK_THAT(point.extras(0), WithinRel(1.0, 1e-9));
}

TEST_CASE("Curves along which their parameter stands still are followed both ways, also from meetings") {
  const TwoOscillators problem;
  for (const double q : {0.0, 1.0, std::nextafter(1.0, 2.0)}) {
    INFO(q);
    BranchPoint point;
    point.type = PointType::hopf;
    point.unknowns = Vector::Zero(4);
    point.parameters = vector_of({0, q});
    point.eigenvalues.resize(4);
    point.eigenvalues << Complex(0, 1), Complex(0, -1), Complex(q - 1, 2), Complex(q - 1, -2);
    CurveStart start = curve_through(problem, "q", point);
    start.point.extras = vector_of({1});
    const Branch curve = trace_curve(*start.problem, start.point, over("p", -1, 1), {-3, 3});
    CHECK(curve.complete());
    const std::vector<BasePoint> points = base_points(*start.problem, curve);
    REQUIRE(points.size() > 10);
    CHECK_THAT(std::abs(points.front().parameters(1) - points.back().parameters(1)), WithinAbs(6, 1e-9));
    for (const BasePoint& at : points) {
      CHECK_THAT(at.parameters(0), WithinAbs(0, 1e-10));
      CHECK_THAT(at.extras(0), WithinRel(1.0, 1e-9));
    }
  }
}

TEST_CASE("Branch points that a symmetry keeps are followed") {
  // (lambda - mu^2) x - x^3 = 0 branches off x = 0 at lambda = mu^2.
  const ScalarProblem problem(
      {"lambda", "mu"}, [](double x, const Vector& p) { return (p(0) - p(1) * p(1)) * x - x * x * x; },
      [](double x, const Vector& p) { return p(0) - p(1) * p(1) - 3 * x * x; },
      {[](double x, const Vector&) { return x; }, [](double x, const Vector& p) { return -2 * p(1) * x; }});
  const Branch branch = trace(problem, {vector_of({0}), vector_of({-1, 0.5})}, over("lambda", -1, 1));
  const auto found = of_type(branch, PointType::branch_point);
  REQUIRE(found.size() == 1);
  CHECK_THAT(found[0].parameters(0), WithinRel(0.25, 1e-10));
  const CurveStart start = curve_through(problem, "lambda", found[0]);
  TraceOptions options = over("mu", -2, 2);
  options.extrema_of = {"lambda"};
  const Branch curve = trace_curve(*start.problem, start.point, options);
  REQUIRE(curve.complete());
  for (const BasePoint& point : base_points(*start.problem, curve)) {
    CHECK_THAT(point.parameters(0), WithinAbs(point.parameters(1) * point.parameters(1), 1e-9));
    CHECK_THAT(point.extras(0), WithinAbs(0, 1e-9));
  }
  const auto lowest = of_type(curve, PointType::trough);
  REQUIRE(lowest.size() == 1);
  CHECK_THAT(lowest[0].parameters(0), WithinAbs(0, 1e-9));
}

TEST_CASE("A border is followed, with its turning points in either parameter") {
  const Parabola problem;
  const Branch branch = trace(problem, {vector_of({-2}), vector_of({-1, 1})}, over("p", -1, 3));
  const auto switches = of_type(branch, PointType::regime_switch);
  REQUIRE(switches.size() == 1);
  const CurveStart start = curve_through(problem, "p", switches[0]);
  TraceOptions options = over("q", -2, 2);
  options.extrema_of = {"p"};
  const Branch curve = trace_curve(*start.problem, start.point, options);
  REQUIRE(curve.complete());
  for (const BasePoint& point : base_points(*start.problem, curve))
    CHECK_THAT(point.parameters(0), WithinAbs(point.parameters(1) * point.parameters(1), 1e-10));
  CHECK(of_type(curve, PointType::trough).size() == 1);

  BorderProblem in_p(problem, 1, 0);  // q is active, so that the curve turns in p
  const Branch turned = trace_curve(in_p, {vector_of({0}), vector_of({1, 1}), 0, {}}, over("p", -1, 3));
  const auto folds = of_type(turned, PointType::fold);
  REQUIRE(folds.size() == 1);
  CHECK_THAT(folds[0].parameters(0), WithinAbs(0, 1e-10));
}

TEST_CASE("A ridge is followed to where its peak and a trough are born together") {
  // u = p^3/3 - q p has its extrema at p^2 = q.
  const ScalarProblem problem(
      {"p", "q"}, [](double u, const Vector& p) { return u - p(0) * p(0) * p(0) / 3 + p(1) * p(0); },
      [](double, const Vector&) { return 1.0; },
      {[](double, const Vector& p) { return -p(0) * p(0) + p(1); },
       [](double, const Vector& p) { return p(0); }});
  TraceOptions options = over("p", -2, 2);
  options.extrema_of = {"u"};
  const Branch branch = trace(problem, {vector_of({-0.7}), vector_of({-2, 1})}, options);
  const auto peaks = of_type(branch, PointType::peak);
  REQUIRE(peaks.size() == 1);
  CHECK_THAT(peaks[0].parameters(0), WithinRel(-1.0, 1e-10));
  const CurveStart start = curve_through(problem, "p", peaks[0], "u");
  const Branch ridge = trace_curve(*start.problem, start.point, over("q", -1, 3));
  REQUIRE(ridge.complete());
  for (const BasePoint& point : base_points(*start.problem, ridge))
    CHECK_THAT(point.parameters(0) * point.parameters(0), WithinAbs(point.parameters(1), 1e-9));
  const auto births = of_type(ridge, PointType::fold);
  REQUIRE(births.size() == 1);
  CHECK_THAT(births[0].parameters(0), WithinAbs(0, 1e-10));
}

TEST_CASE("A curve is not made of points that have none") {
  const ScalarProblem problem = cusp_surface();
  BranchPoint point;
  point.unknowns = vector_of({0});
  point.parameters = vector_of({0, 0});
  CHECK_THROWS_WITH(curve_through(problem, "mu", point), ContainsSubstring("regular"));
  BranchPoint corner;  // within a regime
  corner.type = PointType::corner_fold;
  corner.unknowns = Vector::Constant(1, -0.5);
  corner.parameters = Vector::Constant(1, -0.5);
  CHECK_THROWS_WITH(curve_through(Corner(1, -2), "p", corner), ContainsSubstring("no border"));
  point.type = PointType::fold;
  CHECK_THROWS_WITH(curve_through(problem, "nu", point), ContainsSubstring("mu"));
  FoldProblem folds(problem, 0);
  const Branch none =
      trace_curve(folds, {vector_of({0.1}), vector_of({0, -1}), 0, {}}, over("lambda", -2, 3));
  CHECK(none.points.empty());
  CHECK(none.stop == Stop::no_start);
}
