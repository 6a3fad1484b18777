// Special points of curves in two parameters, and what they cost.

#include <algorithm>
#include <cmath>
#include <numbers>

#include "arcslip/continuation/curves/curve.hpp"
#include "arcslip/continuation/points/fold_problem.hpp"
#include "arcslip/continuation/points/hopf_form.hpp"
#include "arcslip/continuation/points/hopf_problem.hpp"
#include "arcslip/problems/library/ab.hpp"
#include "branches.hpp"
#include "catch.hpp"
#include "scalar_problem.hpp"
#include "sparse_problems.hpp"

using namespace arcslip;
using namespace arcslip::continuation;
using namespace arcslip::testing;

namespace {

/// The Brusselator on a line, x' = Dx x_zz/L^2 + A - (B + 1) x + x^2 y, y' = Dy y_zz/L^2 + B x - x^2 y, x = A
/// and y = B/A at both ends, by differences at inner points. Of the rest state x = A, y = B/A each mode sin(m
/// pi z) has the matrix [B - 1 - Dx l, A^2; -B, -A^2 - Dy l], l the eigenvalue of -d^2/dz^2/L^2.
class Brusselator : public Problem {
 public:
  static constexpr double length = 12, A = 4, Dy = 2;
  explicit Brusselator(Index points) : points_(points) {}
  Index size() const override { return 2 * points_; }
  bool is_equilibrium() const override { return true; }
  std::vector<std::string> parameter_names() const override { return {"Dx", "B"}; }

  bool evaluate(const Vector& u, const Vector& p, const Regime& /*regime*/,
                const Evaluation& out) const override {
    const Index n = points_;
    const double c = coupling(), Dx = p(0), B = p(1);
    const Vector x = u.head(n), y = u.tail(n);
    const Vector bent_x = c * second_difference(x, A), bent_y = c * second_difference(y, B / A);
    const Vector reaction = x.array().square() * y.array();
    if (out.residual != nullptr)
      *out.residual << Dx * bent_x + Vector::Constant(n, A) - (B + 1) * x + reaction,
          Dy * bent_y + B * x - reaction;
    if (out.jacobian != nullptr) {
      out.jacobian->setZero();
      for (Index i = 0; i < n; ++i) {
        const double by_x = 2 * x(i) * y(i), by_y = x(i) * x(i);
        (*out.jacobian)(i, i) = -2 * Dx * c - (B + 1) + by_x;
        (*out.jacobian)(i, n + i) = by_y;
        (*out.jacobian)(n + i, i) = B - by_x;
        (*out.jacobian)(n + i, n + i) = -2 * Dy * c - by_y;
        if (i == 0) continue;
        (*out.jacobian)(i, i - 1) = (*out.jacobian)(i - 1, i) = Dx * c;
        (*out.jacobian)(n + i, n + i - 1) = (*out.jacobian)(n + i - 1, n + i) = Dy * c;
      }
    }
    if (out.parameter_jacobian != nullptr) {
      out.parameter_jacobian->setZero();
      out.parameter_jacobian->col(0).head(n) = bent_x;
      out.parameter_jacobian->col(1) << -x, x;
      for (const Index end : {n, 2 * n - 1}) (*out.parameter_jacobian)(end, 1) += Dy * c / A;
    }
    return true;
  }

  double eigenvalue(int mode) const {
    const double sine = std::sin(0.5 * mode * std::numbers::pi / static_cast<double>(points_ + 1));
    return 4 * coupling() * sine * sine;
  }

  /// B at which the first mode has an imaginary pair: its trace vanishes.
  double hopf(double Dx) const { return 1 + A * A + (Dx + Dy) * eigenvalue(1); }

  /// Of a mode's matrix where the first mode has its pair: linear in Dx.
  double determinant(int mode, double Dx) const {
    const double l = eigenvalue(mode), B = hopf(Dx);
    return (B - 1 - Dx * l) * (-A * A - Dy * l) + A * A * B;
  }

 private:
  double coupling() const {
    const double parts = static_cast<double>(points_ + 1) / length;
    return parts * parts;
  }
  static Vector second_difference(const Vector& x, double at_ends) {
    const Index n = x.size();
    Vector bent = -2 * x;
    bent.head(n - 1) += x.tail(n - 1);
    bent.tail(n - 1) += x.head(n - 1);
    bent(0) += at_ends;
    bent(n - 1) += at_ends;
    return bent;
  }

  Index points_;
};

/// The same equations, counted, with their second derivatives or without.
class CountedCusp : public ScalarProblem {
 public:
  CountedCusp(bool gives_second, Index entries)
      : ScalarProblem(
            {"mu", "lambda"},
            [this](double x, const Vector& p) { return ++evaluations, p(0) + p(1) * x - x * x * x; },
            [](double x, const Vector& p) { return p(1) - 3 * x * x; },
            {[](double, const Vector&) { return 1.0; }, [](double x, const Vector&) { return x; }}),
        gives_second_(gives_second),
        entries_(entries) {}
  bool second(const Vector& u, const Vector& /*p*/, const Regime& /*regime*/, const Vector& w,
              const Vector& du, const Vector& dp, Vector& out) const override {
    out.resize(entries_);
    if (entries_ == 3) out << -6 * u(0) * du(0) + dp(1), 0, du(0);
    out *= w(0);
    return gives_second_;
  }
  mutable long evaluations = 0;

 private:
  bool gives_second_;
  Index entries_;
};

Branch cusp_curve(const Problem& problem, std::vector<std::string> extrema_of = {}) {
  FoldProblem folds(problem, 0);
  TraceOptions options = over("lambda", -1, 3);
  options.extrema_of = std::move(extrema_of);
  return trace_curve(folds, {vector_of({-1}), vector_of({-2, 3}), 0, {}}, options);
}

/// x -> y, y -> c - b x + y^2 + e x y, of which the fixed points x = y have a Jacobian of trace (2 + e) y and
/// determinant b - e y.
class DelayedMap : public Problem {
 public:
  static constexpr double e = 0.3;
  Index size() const override { return 2; }
  std::vector<std::string> parameter_names() const override { return {"c", "b"}; }
  bool is_map() const override { return true; }

  bool evaluate(const Vector& u, const Vector& p, const Regime& /*regime*/,
                const Evaluation& out) const override {
    const double x = u(0), y = u(1), c = p(0), b = p(1);
    if (out.residual != nullptr) *out.residual << y - x, c - b * x + y * y + e * x * y - y;
    if (out.jacobian != nullptr) *out.jacobian << -1, 1, -b + e * y, 2 * y + e * x - 1;
    if (out.parameter_jacobian != nullptr) *out.parameter_jacobian << 0, 0, 1, -x;
    return true;
  }
};

BranchPoint only(const Branch& branch, PointType type) {
  const std::vector<BranchPoint> found = of_type(branch, type);
  REQUIRE(found.size() == 1);
  return found.front();
}

}  // namespace

TEST_CASE("Equilibria of two unknowns have no zero-Hopf points on their fold curves") {
  const problems::StirredTank tank;
  for (double p2 = 10; p2 <= 20; p2 += 0.5) {
    for (const double way : {-1.0, 1.0}) {
      const double B = 0.5 * p2;  // p3 = 1
      const double u1 = 0.5 + way * std::sqrt(0.25 - 1 / B), u2 = B * u1;
      FoldProblem folds(tank, 0);
      const BasePoint start{vector_of({u1, u2}), vector_of({u1 / (1 - u1) * std::exp(-u2), p2, 1}), 0, {}};
      const Branch curve = trace_curve(folds, start, over("p3", 0.5, 4));
      CAPTURE(p2, u1, curve.explanation);
      REQUIRE(curve.points.size() > 10);
      CHECK(of_type(curve, PointType::zero_hopf).empty());
      // They all end in the cusp u1 = 1/2, B = 4, or beyond it on the other arm.
      for (const BranchPoint& point : of_type(curve, PointType::cusp)) {
        CHECK_THAT(point.unknowns(0), WithinRel(0.5, 1e-8));
        CHECK_THAT(point.parameters(1), WithinRel(0.25 * p2 - 1, 1e-8));
      }
    }
  }
}

TEST_CASE("All zero-Hopf points of the discretised Brusselator are found on its curve of Hopf points") {
  const double max_step = GENERATE(0.3, 0.1, 0.05, 0.03, 0.02);
  CAPTURE(max_step);
  const Brusselator problem(30);
  HopfProblem hopf(problem, 1);
  const double Dx = 1.0666, B = problem.hopf(Dx);
  Vector rest(problem.size());
  rest << Vector::Constant(30, Brusselator::A), Vector::Constant(30, B / Brusselator::A);
  TraceOptions options = over("Dx", 1, 1.3);
  options.max_step = max_step;
  const Branch curve =
      trace_curve(hopf, {rest, vector_of({Dx, B}), 0, vector_of({problem.determinant(1, Dx)})}, options);
  REQUIRE(curve.complete());
  std::vector<double> expected;
  for (int mode = 2; mode <= 30; ++mode) {
    const double at_0 = problem.determinant(mode, 0);
    const double zero = at_0 / (at_0 - problem.determinant(mode, 1));
    if (zero > 1 && zero < 1.3) expected.push_back(zero);
  }
  std::sort(expected.begin(), expected.end());
  REQUIRE(expected.size() == 6);
  CHECK(of_type(curve, PointType::generalized_hopf).size() == 3);
  std::vector<double> found;
  for (const BranchPoint& point : curve.points) {
    const BasePoint at = hopf.split(point.unknowns, point.parameters, 0);
    if (point.type == PointType::generalized_hopf) {  // between the poles of l_1 at zero-Hopf points
      const auto l_1 = [&](double moved) {
        const double across = at.parameters(0) + moved, on = problem.hopf(across);
        Vector u(problem.size());
        u << Vector::Constant(30, Brusselator::A), Vector::Constant(30, on / Brusselator::A);
        return hopf_form(problem, {u, vector_of({across, on})}).value().lyapunov;
      };
      CHECK(l_1(-1e-6) * l_1(1e-6) < 0);
      CHECK(std::abs(l_1(0)) < 0.1 * std::abs(l_1(1e-6)));
      continue;
    }
    CHECK((at.unknowns.head(30).array() - Brusselator::A).abs().maxCoeff() < 1e-10);
    CHECK_THAT(at.parameters(1), WithinRel(problem.hopf(at.parameters(0)), 1e-10));
    if (point.type == PointType::regular || point.type == PointType::start || point.type == PointType::end)
      continue;
    CHECK(point.type == PointType::zero_hopf);
    found.push_back(at.parameters(0));
  }
  std::sort(found.begin(), found.end());
  REQUIRE(found.size() == expected.size());
  for (std::size_t i = 0; i < found.size(); ++i) CHECK_THAT(found[i], WithinRel(expected[i], 1e-8));
}

TEST_CASE("A cusp is one point, whatever is made of the parameters that turn there") {
  const CountedCusp problem(false, 3);
  for (const std::vector<std::string>& names : {std::vector<std::string>{}, {"mu"}}) {
    const Branch curve = cusp_curve(problem, names);
    REQUIRE(curve.complete());
    CHECK(of_type(curve, PointType::cusp).size() == 1);
    for (const PointType type : {PointType::fold, PointType::peak, PointType::trough})
      CHECK(of_type(curve, type).empty());
  }
  const Ignition chain(301, true);
  Vector p(2);
  p << 0, 0.1;
  TraceOptions options = over("L", 0, 8);
  options.stop_after = {{PointType::fold, 1, {}}};
  const Branch branch = trace(chain, {Vector::Zero(301), p}, options);
  const CurveStart start = curve_through(chain, "L", of_type(branch, PointType::fold).front());
  TraceOptions over_K = over("K", 0, 0.4);
  over_K.extrema_of = {"L"};
  const Branch curve = trace_curve(*start.problem, start.point, over_K);
  CHECK(of_type(curve, PointType::cusp).size() == 1);
  for (const PointType type : {PointType::fold, PointType::peak, PointType::trough})
    CHECK(of_type(curve, type).empty());
}

TEST_CASE("Curves count all evaluations of their base, and take its own second derivatives") {
  const CountedCusp without(false, 3), with(true, 3);
  const Branch by_differences = cusp_curve(without);
  const Branch by_second = cusp_curve(with);
  REQUIRE(by_differences.complete());
  REQUIRE(by_second.complete());
  CHECK(by_differences.work.evaluations <= without.evaluations);
  // What is left is the comparison of its derivatives.
  CHECK(by_differences.work.evaluations > 0.8 * static_cast<double>(without.evaluations));
  CHECK(3 * with.evaluations < without.evaluations);
  const auto cusp = of_type(by_second, PointType::cusp);
  REQUIRE(cusp.size() == 1);
  CHECK_THAT(cusp[0].unknowns(0), WithinAbs(0, 1e-10));
  CHECK_THROWS_WITH(cusp_curve(CountedCusp(true, 2)),
                    ContainsSubstring("Problem::second: out has 2 entries"));
}

TEST_CASE("The evaluations of a curve do not grow with its unknowns") {
  long fewest = 0;
  for (const Index n : {61, 1001}) {
    const Ignition chain(n, true);
    Vector p(2);
    p << 0, 0.1;
    TraceOptions options = over("L", 0, 8);
    options.stop_after = {{PointType::fold, 1, {}}};
    const Branch branch = trace(chain, {Vector::Zero(n), p}, options);
    const CurveStart start = curve_through(chain, "L", of_type(branch, PointType::fold).front());
    const Branch curve = trace_curve(*start.problem, start.point, over("K", 0, 0.4));
    const long each = curve.work.evaluations / static_cast<long>(curve.points.size());
    CAPTURE(n, curve.points.size());
    CHECK(each < 150);
    if (fewest == 0) fewest = each;
    CHECK(each < 2 * fewest);
  }
}

TEST_CASE("An own map has its special points, stability and curves by being one") {
  const DelayedMap map;
  const double b = 0.5, e = DelayedMap::e;
  const Guess guess{Vector::Constant(2, -0.9), Eigen::Vector2d(-2.5, b)};
  const Branch branch = trace(map, guess, over("c", -2.5, 2));
  const BranchPoint doubling = only(branch, PointType::period_doubling);
  const double square = (1 + b) * (1 + b);
  CHECK_THAT(doubling.parameters(0), WithinAbs(-square / 2 - (1 + e) * square / 4, 1e-9));
  const BranchPoint fold = only(branch, PointType::fold);
  CHECK_THAT(fold.parameters(0), WithinAbs(square / (4 * (1 + e)), 1e-9));
  CHECK(branch.points.front().unstable == 1);
  CHECK(branch.points.back().unstable == 1);
  for (const BranchPoint& point : branch.points) {
    const bool is_between = doubling.arclength < point.arclength && point.arclength < fold.arclength;
    if (is_between) CHECK(point.unstable == 0);
  }

  const CurveStart start = curve_through(map, "c", doubling);
  for (const BranchPoint& point : trace_curve(*start.problem, start.point, over("b", -0.5, 1.5)).points) {
    const BasePoint at = start.problem->split(point.unknowns, point.parameters, point.regime);
    CHECK_THAT(2 * at.unknowns(0) + 1 + at.parameters(1), WithinAbs(0, 1e-9));
  }
}

TEST_CASE("An own map has curves of Neimark-Sacker points with their resonances by being one") {
  const DelayedMap map;
  const Guess guess{Vector::Constant(2, -0.3), Eigen::Vector2d(-0.5, 0.3)};
  const Branch branch = trace(map, guess, over("b", 0.3, 1.5));
  const CurveStart start = curve_through(map, "b", only(branch, PointType::neimark_sacker));
  const Branch curve = trace_curve(*start.problem, start.point, over("c", -1.9, 0.7));
  CHECK(curve.complete());
  for (const BranchPoint& point : curve.points) {
    const BasePoint at = start.problem->split(point.unknowns, point.parameters, point.regime);
    CHECK_THAT(at.parameters(1), WithinAbs(1 + DelayedMap::e * at.unknowns(0), 1e-9));
  }
  const double y = -1 / (2 + DelayedMap::e);
  CHECK_THAT(only(curve, PointType::resonance_1_3).parameters(0), WithinAbs(2 * y - y * y, 1e-8));
  CHECK_THAT(only(curve, PointType::resonance_1_4).parameters(0), WithinAbs(0, 1e-8));
}
