// Sparse problems: that they are traced, extended and checked as dense ones are.

#include <cmath>
#include <limits>

#include "arcslip/continuation/path/trace.hpp"
#include "arcslip/continuation/points/border_problem.hpp"
#include "arcslip/continuation/points/extremum_problem.hpp"
#include "arcslip/continuation/points/normal_form.hpp"
#include "arcslip/continuation/problem/derivative_check.hpp"
#include "branches.hpp"
#include "catch.hpp"
#include "sparse_problems.hpp"

using namespace arcslip;
using namespace arcslip::continuation;
using namespace arcslip::testing;

namespace {

constexpr Index L = 0;
constexpr Index m = 29;

/// Discrete Bratu solutions are symmetric, so that from u(1/2) and L the difference equation gives all
/// others, and u(1), with its derivatives; in extended precision.
struct Shot {
  long double end, by_a, by_L, by_aa, by_aL;
};

Shot shoot(long double a, long double parameter, Index points) {
  const auto h = 1 / static_cast<long double>(points + 1);
  Shot before{};
  Shot now{a, 1, 0, 0, 0};
  for (Index k = 0; k < (points + 1) / 2; ++k) {
    const long double e = h * h * std::exp(now.end);
    const long double s = parameter * e;
    const Shot bend{s, s * now.by_a, e + s * now.by_L, s * (now.by_a * now.by_a + now.by_aa),
                    e * now.by_a + s * (now.by_a * now.by_L + now.by_aL)};
    const auto next = [k](long double old, long double value, long double minus) {
      return k == 0 ? value - minus / 2 : 2 * value - old - minus;
    };
    const Shot after{next(before.end, now.end, bend.end), next(before.by_a, now.by_a, bend.by_a),
                     next(before.by_L, now.by_L, bend.by_L), next(before.by_aa, now.by_aa, bend.by_aa),
                     next(before.by_aL, now.by_aL, bend.by_aL)};
    before = now;
    now = after;
  }
  return now;
}

/// u(1) = 0 and d u(1)/d a = 0: the fold's a = u(1/2) and L, from those of the differential equation.
std::pair<double, double> discrete_fold(Index points) {
  long double a = 1.18684L;
  long double parameter = 3.51383L;
  for (int i = 0; i < 12; ++i) {
    const Shot g = shoot(a, parameter, points);
    const long double determinant = g.by_a * g.by_aL - g.by_L * g.by_aa;
    a -= (g.end * g.by_aL - g.by_L * g.by_a) / determinant;
    parameter -= (g.by_a * g.by_a - g.by_aa * g.end) / determinant;
  }
  return {static_cast<double>(a), static_cast<double>(parameter)};
}

/// L of the lower branch where u(1/2) = a.
double discrete_parameter(long double a, Index points) {
  long double parameter = 1;
  for (int i = 0; i < 30; ++i) {
    const Shot g = shoot(a, parameter, points);
    parameter -= g.end / g.by_L;
  }
  return static_cast<double>(parameter);
}

TraceOptions over_parameter(double from, double to) {
  TraceOptions options;
  options.parameter = "L";
  options.from = from;
  options.to = to;
  return options;
}

Guess at_zero(Index size, double parameter, double perturbation = 0) {
  return {Vector::Zero(size), Vector{{parameter, perturbation}}, 0, {}};
}

Vector place_of(const BranchPoint& point) {
  Vector place(point.unknowns.size() + point.parameters.size());
  place << point.unknowns, point.parameters;
  return place;
}

/// Rounding, and where points are located by it: 1e-9. Along the branch what each step may leave adds up.
void check_same(const Branch& sparse, const Branch& dense) {
  REQUIRE(sparse.stop == dense.stop);
  REQUIRE(sparse.points.size() == dense.points.size());
  for (std::size_t i = 0; i < dense.points.size(); ++i) {
    CAPTURE(i);
    const BranchPoint& a = sparse.points[i];
    const BranchPoint& b = dense.points[i];
    CHECK(a.type == b.type);
    Vector apart = place_of(a) - place_of(b);
    CHECK(apart.lpNorm<Eigen::Infinity>() < 1e-8);
    if (b.type == PointType::regular) {
      const Vector way = (place_of(b) - place_of(dense.points[i - 1])).normalized();
      apart -= way.dot(apart) * way;
    }
    CHECK(apart.lpNorm<Eigen::Infinity>() < 1e-9);
    CHECK((a.tangent - b.tangent).lpNorm<Eigen::Infinity>() < 1e-8);
  }
}

/// Residual and derivatives of two problems at one point.
void check_same_values(const Problem& sparse, const Problem& dense, const Vector& u, const Vector& p) {
  Linearization a(sparse);
  Linearization b(dense);
  REQUIRE(a.evaluate(u, p, 0));
  REQUIRE(b.evaluate(u, p, 0));
  REQUIRE(a.sparse());
  REQUIRE_FALSE(b.sparse());
  // Second derivatives are extrapolated differences, good to 1e-10.
  CHECK((a.residual() - b.residual()).lpNorm<Eigen::Infinity>() < 1e-11);
  CHECK((Matrix(a.sparse_jacobian()) - b.jacobian()).lpNorm<Eigen::Infinity>() < 1e-9);
  CHECK((a.parameter_jacobian() - b.parameter_jacobian()).lpNorm<Eigen::Infinity>() < 1e-9);
}

/// The same with the borders of both adapted to a point, at another one nearby; then solves both.
std::pair<BasePoint, BasePoint> check_extended(ExtendedProblem& sparse, ExtendedProblem& dense,
                                               const BasePoint& guess) {
  Vector u;
  Vector p;
  REQUIRE(sparse.adapt(guess));
  REQUIRE(dense.adapt(guess));
  BasePoint near = guess;
  near.unknowns *= 1.01;
  near.parameters *= 1.001;
  sparse.join(near, u, p);
  check_same_values(sparse, dense, u, p);
  const auto from_sparse = locate(sparse, guess);
  const auto from_dense = locate(dense, guess);
  REQUIRE(from_sparse);
  REQUIRE(from_dense);
  return {from_sparse->point, from_dense->point};
}

BasePoint near_fold(const Problem& problem) {
  TraceOptions options = over_parameter(0, 5);
  options.stop_at = {3.4};
  options.stop_after = {{PointType::user, 1, {}}};
  const Branch branch = trace(problem, at_zero(m, 0), options);
  REQUIRE(branch.complete());
  return {branch.points.back().unknowns, branch.points.back().parameters, 0, {}};
}

class WrongEntry : public Ignition {
 public:
  using Ignition::Ignition;
  bool evaluate(const Vector& u, const Vector& p, const Regime& regime,
                const Evaluation& out) const override {
    Ignition::evaluate(u, p, regime, out);
    if (out.sparse_jacobian != nullptr) out.sparse_jacobian->coeffRef(7, 8) = 1.01;
    return true;
  }
};

/// F_0 depends on an unknown that its row has no entry for; the row of that unknown's group is in use.
class MissingEntry : public Ignition {
 public:
  explicit MissingEntry(Index size, Index on) : Ignition(size, true), on_(on) {}
  bool evaluate(const Vector& u, const Vector& p, const Regime& regime,
                const Evaluation& out) const override {
    Ignition::evaluate(u, p, regime, out);
    if (out.residual != nullptr) (*out.residual)(4) += 0.01 * u(on_);
    return true;
  }

 private:
  Index on_;
};

class WrongGradients : public Ignition {
 public:
  WrongGradients(Index size, bool of_border) : Ignition(size, true), of_border_(of_border) {}
  double border(const Vector& u, const Vector& p, const Regime& regime, int border,
                Gradient* gradient) const override {
    const double value = Ignition::border(u, p, regime, border, gradient);
    if (of_border_ && gradient != nullptr) gradient->unknowns(5) = 0.1;
    return value;
  }
  double observe(const Vector& u, const Vector& p, const Regime& regime, Index which,
                 Gradient& gradient) const override {
    const double value = Ignition::observe(u, p, regime, which, gradient);
    if (!of_border_ && which == 1) gradient.unknowns(6) = 0.1;
    return value;
  }

 private:
  bool of_border_;
};

}  // namespace

TEST_CASE("The derivative checker passes exact sparse derivatives, few or many") {
  const Index size = GENERATE(3, 29, 2001);
  const Vector u = Vector::LinSpaced(size, 0.3, 1.2);
  const Vector p{{2.0, 0.1}};
  const DerivativeReport report = check_derivatives(Ignition(size, true), u, p, 0);
  CAPTURE(report.where);
  CHECK(report.worst < 1e-9);
  CHECK(report.worst > 0);
  const Vector on_square = Vector::LinSpaced(400, 0.3, 1.2);
  CHECK(check_derivatives(BratuRectangle(20, 20), on_square, Vector{{3.0}}, 0).worst < 1e-9);
}

TEST_CASE("The derivative checker names a wrong sparse entry and one that the pattern lacks") {
  const Index size = GENERATE(29, 2001);
  const Vector u = Vector::LinSpaced(size, 0.3, 1.2);
  const Vector p{{2.0, 0.1}};
  const DerivativeReport wrong = check_derivatives(WrongEntry(size, true), u, p, 0);
  CHECK(wrong.where == "dF7/du8");
  CHECK_THAT(wrong.worst, WithinRel(0.01 / 2.01, 1e-3));
  for (const Index on : {Index{6}, Index{7}, Index{8}, size - 1}) {
    const DerivativeReport missing = check_derivatives(MissingEntry(size, on), u, p, 0);
    CHECK(missing.where == "dF4/du" + std::to_string(on) + ", which the pattern lacks");
  }
}

TEST_CASE("The derivative checker names wrong gradients of borders and observables of many unknowns") {
  const Index size = GENERATE(29, 2001);
  const Vector u = Vector::LinSpaced(size, 0.3, 1.2);
  const Vector p{{2.0, 0.1}};
  CHECK(check_derivatives(WrongGradients(size, true), u, p, 0).where == "d border 0/du5");
  CHECK(check_derivatives(WrongGradients(size, false), u, p, 0).where == "d L/du6");
}

TEST_CASE("A sparse problem is traced as the same problem is that is dense") {
  const double K = GENERATE(0.0, 0.2);  // one fold, and two
  TraceOptions options = over_parameter(0, 8);
  options.extrema_of = {"L"};
  const Branch sparse = trace(Ignition(m, true, 40), at_zero(m, 0, K), options);
  const Branch dense = trace(Ignition(m, false, 40), at_zero(m, 0, K), options);
  CHECK(of_type(dense, PointType::fold).size() == (K == 0 ? 1 : 2));
  check_same(sparse, dense);
}

TEST_CASE("A sparse branch ends on its border where the difference equation has it") {
  const Branch branch = trace(Ignition(m, true, 1), at_zero(m, 0), over_parameter(0, 5));
  REQUIRE(branch.stop == Stop::left_regime);
  CHECK_THAT(branch.points.back().parameters(L), WithinRel(discrete_parameter(1, m), 1e-11));
}

TEST_CASE("The fold of a sparse branch is that of the difference equation") {
  const Index size = GENERATE(1, 9, 29, 199);
  TraceOptions options = over_parameter(0, 10);
  options.stop_after = {{PointType::fold, 1, {}}};
  const Branch branch = trace(Ignition(size, true), at_zero(size, 0), options);
  REQUIRE(branch.complete());
  const auto [middle, parameter] = discrete_fold(size);
  const BranchPoint& fold = branch.points.back();
  CHECK_THAT(fold.parameters(L), WithinRel(parameter, 1e-10));
  // The residuals' rounding stands for one of 1e-16/h^2 in L, and its root along the branch.
  CHECK_THAT(fold.unknowns(size / 2), WithinRel(middle, 1e-7));
}

TEST_CASE("The fold of Bratu's problem in the square is the published one, by the branch and by itself") {
  const auto fold_at = [](Index side) {
    const BratuRectangle square(side, side);
    TraceOptions options = over_parameter(0, 10);
    options.stop_after = {{PointType::fold, 1, {}}};
    const Branch branch = trace(square, {Vector::Zero(square.size()), Vector{{0.0}}, 0, {}}, options);
    REQUIRE(branch.complete());
    const BranchPoint& traced = branch.points.back();
    FoldProblem problem(square, L);
    const auto located = locate(problem, {traced.unknowns, traced.parameters, 0, {}});
    REQUIRE(located);
    CHECK_THAT(traced.parameters(L), WithinRel(located->point.parameters(L), 1e-10));
    return traced.parameters(L);
  };
  const double coarse = fold_at(15);
  const double fine = fold_at(31);
  // 6.80812442259: Bolstad & Keller, SIAM J. Sci. Stat. Comput. 7 (1986) 1081, by a scheme of sixth order.
  // Extrapolated the error is of order h^4 = 1e-6, times the solution's sixth derivatives.
  CHECK_THAT(fine + (fine - coarse) / 3, WithinRel(6.80812442259, 3e-5));
}

TEST_CASE("Branch points of a sparse branch are those of the difference equation") {
  TraceOptions options = over_parameter(1, 100);
  options.max_step = 0.3;
  const Branch branch = trace(Buckling(m, true), at_zero(m, 1), options);
  REQUIRE(branch.complete());
  const auto points = of_type(branch, PointType::branch_point);
  REQUIRE(points.size() == 3);
  const double h = 1 / static_cast<double>(m + 1);
  for (std::size_t k = 1; k <= points.size(); ++k) {
    const double exact = (2 - 2 * std::cos(static_cast<double>(k) * std::acos(-1.0) * h)) / (h * h);
    CHECK_THAT(points[k - 1].parameters(L), WithinRel(exact, 1e-10));
  }
}

TEST_CASE("Folds as a sparse extended problem") {
  const Ignition sparse_base(m, true);
  const Ignition dense_base(m, false);
  FoldProblem sparse(sparse_base, L);
  FoldProblem dense(dense_base, L);
  const auto [a, b] = check_extended(sparse, dense, near_fold(dense_base));
  const auto [middle, parameter] = discrete_fold(m);
  for (const BasePoint& point : {a, b}) {
    CHECK_THAT(point.parameters(L), WithinRel(parameter, 1e-12));
    CHECK_THAT(point.unknowns(m / 2), WithinRel(middle, 1e-10));
  }
}

TEST_CASE("Branch points as a sparse extended problem") {
  const Buckling sparse_base(m, true);
  const Buckling dense_base(m, false);
  BranchPointProblem sparse(sparse_base, L);
  BranchPointProblem dense(dense_base, L);
  const double h = 1 / static_cast<double>(m + 1);
  const BasePoint guess{Vector::LinSpaced(m, 0.01, 0.02), Vector{{9.7, 0.0}}, 0, Vector::Zero(1)};
  const auto [a, b] = check_extended(sparse, dense, guess);
  for (const BasePoint& point : {a, b}) {
    CHECK_THAT(point.parameters(L), WithinRel((2 - 2 * std::cos(std::acos(-1.0) * h)) / (h * h), 1e-11));
    CHECK(point.unknowns.lpNorm<Eigen::Infinity>() < 1e-9);
  }
}

TEST_CASE("Points on a border as a sparse extended problem") {
  const Ignition sparse_base(m, true, 1);
  const Ignition dense_base(m, false, 1);
  BorderProblem sparse(sparse_base, L, 0);
  BorderProblem dense(dense_base, L, 0);
  const BasePoint guess = near_fold(Ignition(m, false));
  const auto [a, b] = check_extended(sparse, dense, guess);
  for (const BasePoint& point : {a, b})
    CHECK_THAT(point.parameters(L), WithinRel(discrete_parameter(1, m), 1e-11));
}

TEST_CASE("Extrema as a sparse extended problem: those of L are its folds") {
  const Ignition sparse_base(m, true);
  const Ignition dense_base(m, false);
  ExtremumProblem sparse(sparse_base, L, 1);
  ExtremumProblem dense(dense_base, L, 1);
  const auto [a, b] = check_extended(sparse, dense, near_fold(dense_base));
  for (const BasePoint& point : {a, b})
    CHECK_THAT(point.parameters(L), WithinRel(discrete_fold(m).second, 1e-11));
}

TEST_CASE("The curve of folds of a sparse problem has the cusp of the dense one") {
  const auto cusps = [](bool sparse) {
    const Ignition base(m, sparse);
    FoldProblem problem(base, L);
    const auto fold = locate(problem, near_fold(base));
    REQUIRE(fold);
    Guess guess;
    problem.join(fold->point, guess.unknowns, guess.parameters);
    TraceOptions options = over_parameter(0, 0.5);
    options.parameter = "K";
    options.stop_after = {{PointType::cusp, 1, {}}};
    return trace(problem, guess, options);
  };
  const Branch sparse = cusps(true);
  const Branch dense = cusps(false);
  REQUIRE(sparse.complete());
  REQUIRE(dense.complete());
  CHECK(sparse.points.back().type == PointType::cusp);
  // Located by the zero of a function of exact second derivatives, which are differences good to 1e-10.
  CHECK_THAT(sparse.points.back().parameters(0), WithinRel(dense.points.back().parameters(0), 1e-8));
}
