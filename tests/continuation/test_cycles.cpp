#include "arcslip/continuation/cycles/cycle_branch.hpp"

#include <cmath>

#include "arcslip/continuation/curves/curve.hpp"
#include "arcslip/continuation/cycles/floquet.hpp"
#include "arcslip/continuation/cycles/settled_cycle.hpp"
#include "arcslip/continuation/linear/sparse_bordered_solver.hpp"
#include "arcslip/continuation/path/newton.hpp"
#include "arcslip/continuation/problem/derivative_check.hpp"
#include "branches.hpp"
#include "catch.hpp"
#include "flow.hpp"

using namespace arcslip;
using namespace arcslip::continuation;
using namespace arcslip::testing;

namespace {

/// Cycles of radius sqrt(mu) that turn with omega = 1 + mu: T = 2 pi/(1 + mu), multiplier e^(-2 mu T).
std::shared_ptr<const Problem> hopf_normal_form() {
  return make_flow(2, {"mu"}, [](const auto& u, const auto& p, auto& f) {
    const auto square = u[0] * u[0] + u[1] * u[1];
    const auto turn = 1.0 + p[0];
    f[0] = p[0] * u[0] - turn * u[1] - u[0] * square;
    f[1] = turn * u[0] + p[0] * u[1] - u[1] * square;
  });
}

std::shared_ptr<const Problem> van_der_pol() {
  return make_flow(2, {"mu"}, [](const auto& u, const auto& p, auto& f) {
    f[0] = u[1];
    f[1] = p[0] * (1.0 - u[0] * u[0]) * u[1] - u[0];
  });
}

std::shared_ptr<const Problem> lorenz() {
  return make_flow(3, {"rho", "beta", "sigma"}, [](const auto& u, const auto& p, auto& f) {
    f[0] = p[2] * (u[1] - u[0]);
    f[1] = p[0] * u[0] - u[1] - u[0] * u[2];
    f[2] = u[0] * u[1] - p[1] * u[2];
  });
}

std::shared_ptr<const Problem> roessler() {
  return make_flow(3, {"c", "a"}, [](const auto& u, const auto& p, auto& f) {
    f[0] = -u[1] - u[2];
    f[1] = u[0] + p[1] * u[1];
    f[2] = 0.2 + u[2] * (u[0] - p[0]);
  });
}

/// x' = mu x - y - x (x^2 + y^2), y' likewise, beside z: a pair of multipliers e^((a - j nu) T) of a cycle of
/// radius 1 and T = 2 pi, as two of its unknowns turn by themselves.
std::shared_ptr<const Problem> with_rider() {
  return make_flow(4, {"a", "nu"}, [](const auto& u, const auto& p, auto& f) {
    const auto square = u[0] * u[0] + u[1] * u[1];
    f[0] = u[0] - u[1] - u[0] * square;
    f[1] = u[0] + u[1] - u[1] * square;
    f[2] = p[0] * u[2] - p[1] * u[3] + 0.1 * u[0] * u[2];
    f[3] = p[1] * u[2] + p[0] * u[3] + 0.1 * u[0] * u[3];
  });
}

/// The equilibria from a guess, then all cycles.
std::vector<CycleBranch> cycles_of(const std::shared_ptr<const Problem>& problem, const Vector& u,
                                   const Vector& p, const TraceOptions& options,
                                   const CycleOptions& cycles = {}) {
  const Branch equilibria = trace(*problem, {u, p}, options);
  REQUIRE(equilibria.complete());
  return trace_cycles_leaving(std::make_shared<EquilibriumField>(problem), {equilibria}, options, cycles);
}

/// A circle of radius r as an orbit of n unknowns, in the first two; one that turns the other way where r <
/// 0.
Matrix circle(const OrbitMesh& mesh, Index n, double r, double phase = 0) {
  Matrix orbit = Matrix::Zero(n, mesh.nodes());
  for (Index node = 0; node < mesh.nodes(); ++node) {
    orbit(0, node) = std::abs(r) * std::cos(two_pi * mesh.place(node) + phase);
    orbit(1, node) = r * std::sin(two_pi * mesh.place(node) + phase);
  }
  return orbit;
}

/// The cycle of van der Pol's oscillator at mu = 1 on a mesh: its period.
double period_of_van_der_pol(int degree, Index intervals) {
  const OrbitMesh mesh(CollocationRule(degree), intervals);
  const CycleStart start = cycle_from_orbit(std::make_shared<EquilibriumField>(van_der_pol()), mesh,
                                            circle(mesh, 2, -2), 6.6, Vector::Constant(1, 1));
  const Solution solution = solve(*start.problem, start.guess);
  REQUIRE(solution.outcome == Correction::converged);
  return solution.unknowns.tail(1)(0);
}

/// Roessler's cycle at c = 2 and this a, by way of the Hopf point over a.
CycleStart roessler_at(double a) {
  const auto all =
      cycles_of(roessler(), Eigen::Vector3d(0, 0, 0.1), Eigen::Vector2d(2, 0.001), over("a", 0.001, a));
  REQUIRE(all.size() == 1);
  const CycleProblem& problem = *all[0].problem;
  const BranchPoint& end = all[0].branch.points.back();
  REQUIRE(all[0].branch.stop == Stop::reached_end);
  return cycle_from_orbit(problem.shared_field(), problem.frame(end.regime).mesh, problem.orbit(end.unknowns),
                          problem.duration(end.unknowns, end.parameters), end.parameters);
}

}  // namespace

TEST_CASE("Cycles of a Hopf normal form are its circles", "[cycles]") {
  const auto all =
      cycles_of(hopf_normal_form(), Vector::Zero(2), Vector::Constant(1, -0.5), over("mu", -0.5, 2));
  REQUIRE(all.size() == 1);
  const CycleProblem& problem = *all[0].problem;
  const Branch& branch = all[0].branch;
  CHECK(branch.stop == Stop::reached_end);
  for (const BranchPoint& point : branch.points) {
    const double mu = point.parameters(0);
    const double period = two_pi / (1 + mu);
    Vector observed;
    problem.observe(point.unknowns, point.parameters, point.regime, observed);
    CHECK_THAT(observed(0), WithinRel(period, 1e-9));
    CHECK_THAT(observed(1), WithinAbs(std::sqrt(mu), 1e-7));
    CHECK_THAT(observed(5), WithinAbs(std::sqrt(mu), 1e-8));
    const ComplexVector logs = problem.log_multipliers(point.unknowns, point.parameters, point.regime);
    REQUIRE(logs.size() == 1);
    CHECK_THAT(logs(0).real(), WithinAbs(-2 * mu * period, 1e-7));
    CHECK(point.unstable == 0);
  }
}

TEST_CASE("Cycles leave a Hopf point as large in any unit of time", "[cycles]") {
  for (const double rate : {1.0, 1e3, 1e6}) {
    INFO("rate " << rate);
    const auto oscillator = make_flow(2, {"mu"}, [=](const auto& u, const auto& p, auto& f) {
      const auto x = u[0] - 5.0;
      f[0] = u[1];
      f[1] = rate * (p[0] - x * x) * u[1] - rate * rate * (x + 0.3 * x * x);
    });
    const auto all =
        cycles_of(oscillator, Eigen::Vector2d(5, 0), Vector::Constant(1, -0.5), over("mu", -0.5, 0.5));
    REQUIRE(all.size() == 1);
    const Branch& branch = all[0].branch;
    CHECK(branch.stop == Stop::reached_end);
    for (const BranchPoint& point : branch.points) CHECK(point.type != PointType::fold);
    Vector least;
    Vector most;
    for (Vector* observed : {&least, &most}) {
      const BranchPoint& point = observed == &least ? branch.points.front() : branch.points.back();
      all[0].problem->observe(point.unknowns, point.parameters, point.regime, *observed);
    }
    CHECK_THAT(least(1), WithinRel(5.005, 1e-4));
    CHECK_THAT(most(0) * rate, WithinRel(7.1, 0.1));
  }
}

/// 60 points of a branch from an orbit, each of little more than one factorisation and all that a point has.
void check_cost(const CycleStart& start, TraceOptions options) {
  options.max_points = 60;
  const CycleBranch all = trace_cycles(start, options, {});
  const Branch& branch = all.branch;
  REQUIRE(branch.points.size() >= 60);
  constexpr long at_start = 3;  // looks ahead, for what vanishes there
  CHECK(branch.work.factorizations - at_start < 5 * std::ssize(branch.points) / 4);
  for (std::size_t i = 0; i < branch.points.size(); i += 7) {
    const BranchPoint& point = branch.points[i];
    const Solution solution = solve(*all.problem, {point.unknowns, point.parameters, point.regime});
    REQUIRE(solution.outcome == Correction::converged);
    CHECK((solution.unknowns - point.unknowns).lpNorm<Eigen::Infinity>() < 1e-9);
    ComplexVector anew;  // the point's own are by the Jacobian that was at hand
    REQUIRE(all.problem->eigenvalues(point.unknowns, point.parameters, point.regime, anew));
    REQUIRE(point.eigenvalues.size() == anew.size());
    CHECK((point.eigenvalues - anew).cwiseAbs().maxCoeff() < 1e-8);
  }
}

TEST_CASE("Points of short steps take little more than one factorisation each", "[cycles]") {
  const OrbitMesh mesh(CollocationRule(4), 30);
  TraceOptions options = over("mu", 0.5, 2);
  options.max_step = 0.001;
  check_cost(cycle_from_orbit(std::make_shared<EquilibriumField>(van_der_pol()), mesh, circle(mesh, 2, -2),
                              6.6, Vector::Constant(1, 1)),
             options);
  // The scale of all 242 unknowns grows with the orbit, and no two branch points are near for all that.
  options = over("mu", 0.1, 2);
  options.max_step = 0.01;
  check_cost(cycle_from_orbit(std::make_shared<EquilibriumField>(hopf_normal_form()), mesh,
                              circle(mesh, 2, std::sqrt(0.2)), two_pi / 1.2, Vector::Constant(1, 0.2)),
             options);
}

TEST_CASE("What factors have left of intervals tells what these make of changes", "[cycles]") {
  for (const Index intervals : {8, 9, 30}) {  // four are eliminated side by side
    const OrbitMesh mesh(CollocationRule(3), intervals);
    const CycleStart start = cycle_from_orbit(std::make_shared<EquilibriumField>(van_der_pol()), mesh,
                                              circle(mesh, 2, -2), 6.6, Vector::Constant(1, 1));
    SparseMatrix jacobian;
    Evaluation out;
    out.sparse_jacobian = &jacobian;
    REQUIRE(start.problem->evaluate(start.guess.unknowns, start.guess.parameters, {}, out));
    const Index size = start.problem->size();
    SparseBorderedSolver solver(size, 1);
    const Vector scale = Vector::LinSpaced(size + 1, 0.1, 7);
    solver.set_jacobian(jacobian, scale);
    solver.columns() = Matrix::Constant(size, 1, 0.3);
    solver.rows() = Matrix::Constant(1, size, 0.2);
    solver.corner()(0, 0) = 1;
    REQUIRE(solver.factor() != 0);
    REQUIRE(solver.rows_left() != nullptr);
    const std::vector<Matrix> by_factors = start.problem->transfers({jacobian, solver.rows_left(), &scale});
    const std::vector<Matrix> by_entries = start.problem->transfers({jacobian});
    REQUIRE(std::ssize(by_factors) == intervals);
    for (std::size_t j = 0; j < by_factors.size(); ++j)
      CHECK((by_factors[j] - by_entries[j]).cwiseAbs().maxCoeff() < 1e-12 * by_entries[j].norm());
  }
}

TEST_CASE("Collocation converges at twice its degree at the ends of intervals", "[cycles]") {
  // 17 digits by a Taylor series of order 30 with 40 digits
  const double exact = period_of_van_der_pol(7, 64);
  CHECK_THAT(exact, WithinRel(6.6632868593231301, 1e-13));
  for (const int degree : {2, 3, 4}) {
    const double coarse = std::abs(period_of_van_der_pol(degree, 32) - exact);
    const double fine = std::abs(period_of_van_der_pol(degree, 64) - exact);
    INFO("degree " << degree << ", errors " << coarse << " and " << fine);
    CHECK(std::abs(std::log2(coarse / fine) - 2 * degree) < 0.35);
  }
}

TEST_CASE("Derivatives of cycles and of their special points are exact", "[cycles]") {
  const auto problem = lorenz();
  const OrbitMesh mesh(CollocationRule(3), 5);
  Matrix orbit = circle(mesh, 3, 2, 0.3);
  orbit.row(2).setConstant(9);
  orbit.row(2) += 0.7 * orbit.row(0);
  const CycleStart start = cycle_from_orbit(std::make_shared<EquilibriumField>(problem), mesh, orbit, 0.8,
                                            Eigen::Vector3d(20, 2.5, 10));
  const DerivativeReport report =
      check_derivatives(*start.problem, start.guess.unknowns, start.guess.parameters, start.guess.regime);
  INFO(report.where);
  CHECK(report.worst < 1e-7);
}

TEST_CASE("Lorenz' cycles end on his homoclinic orbit", "[cycles]") {
  TraceOptions options = over("rho", 10, 30);
  const auto all =
      cycles_of(lorenz(), Eigen::Vector3d(4.9, 4.9, 9), Eigen::Vector3d(10, 8.0 / 3, 10), options);
  REQUIRE(all.size() == 1);
  const Branch& branch = all[0].branch;
  CHECK(branch.stop == Stop::infinite_period);
  const BranchPoint& last = branch.points.back();
  // [Sparrow, The Lorenz Equations, Springer 1982: 13.926]; by shooting along the unstable manifold
  CHECK_THAT(last.parameters(0), WithinAbs(13.926557407, 2e-8));
  CHECK(of_type(branch, PointType::fold).empty());
}

TEST_CASE("Roessler's cycles double their periods", "[cycles]") {
  CycleOptions cycles;
  cycles.doublings = 2;
  const CycleStart start = roessler_at(0.2);
  const CycleBranch single = trace_cycles(start, over("c", 2, 4.5), cycles);
  const auto first = of_type(single.branch, PointType::period_doubling);
  REQUIRE(!first.empty());
  CHECK_THAT(first[0].parameters(0), WithinAbs(2.832445, 2e-6));
  const auto doubled = orbit_from_doubling(*single.problem, 0, first[0]);
  REQUIRE(doubled);
  const CycleBranch twice = cycle_branch(trace_orbits(*doubled, over("c", 2, 4.5), cycles));
  CHECK(twice.problem->periods() == 2);
  const auto second = of_type(twice.branch, PointType::period_doubling);
  REQUIRE(!second.empty());
  CHECK_THAT(second[0].parameters(0), WithinAbs(3.837, 2e-3));
}

TEST_CASE("Tori leave where a pair of multipliers crosses the circle, at exactly known places",
          "[cycles][long]") {
  // The mean of 0.1 u_0 over the cycle is 0: the multipliers are e^(2 pi (a +- j nu)).
  const OrbitMesh mesh(CollocationRule(5), 12);
  const CycleStart start = cycle_from_orbit(std::make_shared<EquilibriumField>(with_rider()), mesh,
                                            circle(mesh, 4, 1), two_pi, Eigen::Vector2d(-0.1, 0.15));
  const CycleBranch traced = trace_cycles(start, over("a", -0.1, 0.1));
  const auto tori = of_type(traced.branch, PointType::neimark_sacker);
  REQUIRE(tori.size() == 1);
  CHECK_THAT(tori[0].parameters(0), WithinAbs(0, 1e-9));
  CurveStart curve = curve_through(*traced.problem, "a", tori[0]);
  const Branch along = trace_curve(*curve.problem, curve.point, over("nu", 0.05, 0.3), {-1, 1});
  CHECK(along.complete());
  REQUIRE(along.points.size() > 4);
  for (const BranchPoint& point : along.points) {
    const BasePoint at = curve.problem->split(point.unknowns, point.parameters, point.regime);
    CHECK_THAT(at.parameters(0), WithinAbs(0, 1e-9));
    CHECK_THAT(at.extras(0), WithinAbs(std::cos(two_pi * at.parameters(1)), 1e-8));
  }
}

TEST_CASE("An angle that goes round has the period of its closed form", "[cycles]") {
  class Rotor : public EquilibriumField {
   public:
    using EquilibriumField::EquilibriumField;
    double turn(Index unknown) const override { return unknown == 0 ? two_pi : 0; }
  };
  // phi' = a - sin phi: T = 2 pi/sqrt(a^2 - 1), without end at a = 1; z follows it
  const auto flow = make_flow(2, {"a"}, [](const auto& u, const auto& p, auto& f) {
    using std::sin;
    f[0] = p[0] - sin(u[0]);
    f[1] = 0.5 * (sin(u[0]) - u[1]);
  });
  const CycleStart start =
      settled_cycle(std::make_shared<Rotor>(flow), Eigen::Vector2d(0.3, 0), Vector::Constant(1, 2), 60);
  CHECK(start.problem->winding() == Eigen::Vector2d(two_pi, 0));
  const CycleBranch traced = trace_cycles(start, over("a", 2, 0.9));
  CHECK(traced.branch.stop == Stop::infinite_period);
  REQUIRE(traced.branch.points.size() > 5);
  for (const BranchPoint& point : traced.branch.points) {
    const double a = point.parameters(0);
    if (a < 1.0001) continue;
    CHECK_THAT(traced.problem->duration(point.unknowns, point.parameters),
               WithinRel(two_pi / std::sqrt(a * a - 1), 1e-8));
    if (a < 1.01) continue;  // where an orbit rests long its few intervals do not tell how fast others come
    const ComplexVector logs =
        traced.problem->log_multipliers(point.unknowns, point.parameters, point.regime);
    REQUIRE(logs.size() == 1);
    CHECK_THAT(logs(0).real(), WithinRel(-pi / std::sqrt(a * a - 1), 1e-8));
  }
}

TEST_CASE("Curves of period doublings pass those of branches across them", "[cycles]") {
  const auto doubling = [](double a) {
    const CycleBranch branch = trace_cycles(roessler_at(a), over("c", 2, 3.5));
    const auto found = of_type(branch.branch, PointType::period_doubling);
    REQUIRE(!found.empty());
    return std::pair{branch.problem, found[0]};
  };
  const auto [problem, first] = doubling(0.2);
  CurveStart curve = curve_through(*problem, "c", first);
  TraceOptions along = over("a", 0.2, 0.22);
  along.stop_at = {0.21};
  const Branch traced = trace_curve(*curve.problem, curve.point, along, {0, 10});
  const auto there = of_type(traced, PointType::user);
  REQUIRE(there.size() == 1);
  const BasePoint at = curve.problem->split(there[0].unknowns, there[0].parameters, there[0].regime);
  CHECK_THAT(at.parameters(0), WithinAbs(doubling(0.21).second.parameters(0), 1e-8));
}
