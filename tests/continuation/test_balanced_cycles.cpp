// Cycles as trigonometric polynomials: against closed forms and cycles on intervals.

#include <algorithm>
#include <cmath>

#include "arcslip/continuation/cycles/cycle_branch.hpp"
#include "arcslip/continuation/path/newton.hpp"
#include "arcslip/continuation/problem/derivative_check.hpp"
#include "branches.hpp"
#include "catch.hpp"
#include "flow.hpp"

namespace arcslip::testing::balanced {

using namespace arcslip::continuation;

namespace {

/// Cycles of radius sqrt(mu) that turn with omega = 1 + mu: T = 2 pi/(1 + mu), multiplier e^(-2 mu T).
std::shared_ptr<const Problem> normal_form() {
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

/// A rotor whose angle goes round: phi' = 1 + a cos(phi), T = 2 pi/sqrt(1 - a^2).
class Rotor : public Field {
 public:
  Index size() const override { return 1; }
  std::vector<std::string> names() const override { return {"phi"}; }
  std::vector<std::string> parameter_names() const override { return {"a"}; }
  double turn(Index /*unknown*/) const override { return two_pi; }
  [[nodiscard]] bool evaluate(double /*t*/, const Vector& u, const Vector& p,
                              const FieldValues& out) const override {
    if (out.velocity != nullptr) (*out.velocity)(0) = 1 + p(0) * std::cos(u(0));
    if (out.by_unknowns != nullptr) (*out.by_unknowns)(0, 0) = -p(0) * std::sin(u(0));
    if (out.by_parameters != nullptr) (*out.by_parameters)(0, 0) = std::cos(u(0));
    return true;
  }
};

OrbitMesh waves(int count) { return {CollocationRule::trigonometric(count), 1}; }

/// A circle of two unknowns.
Matrix circle(const OrbitMesh& mesh, double r) {
  Matrix orbit(2, mesh.nodes());
  for (Index node = 0; node < mesh.nodes(); ++node)
    orbit.col(node) << std::abs(r) * std::cos(two_pi * mesh.place(node)),
        r * std::sin(two_pi * mesh.place(node));
  return orbit;
}

struct Found {
  CycleStart start;
  Solution solution;
};

Found van_der_pol_on(const OrbitMesh& mesh) {
  Found found{cycle_from_orbit(std::make_shared<EquilibriumField>(van_der_pol()), mesh, circle(mesh, -2), 6.6,
                               Vector::Constant(1, 1)),
              {}};
  found.solution = solve(*found.start.problem, found.start.guess);
  REQUIRE(found.solution.outcome == Correction::converged);
  return found;
}

}  // namespace

TEST_CASE("A trigonometric rule is exact for waves beside linear growth", "[balance]") {
  const auto rule = CollocationRule::trigonometric(3);
  const OrbitMesh mesh(rule, 1);
  const auto wave = [](double s) {
    return 0.3 + 2 * s + std::cos(two_pi * 3 * s) - 0.4 * std::sin(two_pi * 3 * s) +
           0.7 * std::sin(two_pi * s);
  };
  Matrix values(1, mesh.nodes());
  for (Index node = 0; node < mesh.nodes(); ++node) values(0, node) = wave(mesh.place(node));
  Vector value;
  Vector slope;
  for (const double s : {0.0, 0.13, 0.5, 1 - 1e-9, 1.0}) {
    mesh.at(values, s, value, &slope);
    CHECK_THAT(value(0), WithinAbs(wave(s), 1e-13));
    const double exact = 2 - two_pi * 3 * (std::sin(two_pi * 3 * s) + 0.4 * std::cos(two_pi * 3 * s)) +
                         two_pi * 0.7 * std::cos(two_pi * s);
    CHECK_THAT(slope(0), WithinAbs(exact, 1e-12));
  }
  const Matrix found = rule.coefficients(values);
  const Vector wanted = (Vector(7) << 0.3, 0, 0.7, 0, 0, 1, -0.4).finished();
  CHECK((found.row(0).transpose() - wanted).cwiseAbs().maxCoeff() < 1e-14);
  CHECK_THAT(mesh.errors(values, Vector::Ones(1))(0), WithinAbs(std::hypot(1, 0.4), 1e-13));
}

TEST_CASE("Balanced cycles of a Hopf normal form are its circles", "[balance]") {
  const Branch equilibria =
      trace(*normal_form(), {Vector::Zero(2), Vector::Constant(1, -0.5)}, over("mu", -0.5, 2));
  const auto all =
      trace_cycles_leaving(std::make_shared<EquilibriumField>(normal_form()), {equilibria},
                           over("mu", -0.5, 2), {.trigonometric = true, .waves = 3, .tolerance = 1e-10});
  REQUIRE(all.size() == 1);
  CHECK(all[0].branch.stop == Stop::reached_end);
  CHECK(all[0].problem->resolution() == 3);
  for (const BranchPoint& point : all[0].branch.points) {
    const double mu = point.parameters(0);
    const double period = two_pi / (1 + mu);
    Vector observed;
    all[0].problem->observe(point.unknowns, point.parameters, point.regime, observed);
    CHECK_THAT(observed(0), WithinRel(period, 1e-11));
    for (const Index i : {1, 3}) CHECK_THAT(observed(i), WithinAbs(std::sqrt(mu), 1e-11));
    CHECK_THAT(observed(2), WithinAbs(-std::sqrt(mu), 1e-11));
    CHECK_THAT(observed(5), WithinAbs(std::sqrt(mu), 1e-11));
    const ComplexVector logs =
        all[0].problem->log_multipliers(point.unknowns, point.parameters, point.regime);
    REQUIRE(logs.size() == 1);
    CHECK_THAT(logs(0).real(), WithinAbs(-2 * mu * period, 1e-9));
  }
}

TEST_CASE("Twice as many waves hold twice as many digits", "[balance]") {
  const double exact = 6.6632868593231301;  // as for cycles on intervals
  std::vector<double> errors;
  for (const int count : {8, 16, 32})
    errors.push_back(std::abs(van_der_pol_on(waves(count)).solution.unknowns.tail(1)(0) - exact));
  INFO("errors " << errors[0] << ", " << errors[1] << " and " << errors[2]);
  CHECK(errors[0] > 1e-6);
  CHECK(std::log(errors[1]) / std::log(errors[0]) > 1.6);
  CHECK(std::log(errors[2]) / std::log(errors[1]) > 1.6);
  CHECK_THAT(van_der_pol_on(waves(48)).solution.unknowns.tail(1)(0), WithinRel(exact, 1e-13));
}

TEST_CASE("Multipliers and derivatives of balanced cycles are those on intervals", "[balance]") {
  const Found balanced = van_der_pol_on(waves(40));
  const Found meshed = van_der_pol_on(OrbitMesh(CollocationRule(7), 60));
  const auto log = [](const Found& found) {
    return found.start.problem->log_multipliers(found.solution.unknowns, found.start.guess.parameters, {})(0)
        .real();
  };
  CHECK_THAT(log(balanced), WithinRel(log(meshed), 1e-9));
  const DerivativeReport report = check_derivatives(*balanced.start.problem, balanced.solution.unknowns,
                                                    balanced.start.guess.parameters, {});
  INFO(report.where);
  CHECK(report.worst < 1e-7);
}

TEST_CASE("An angle goes round in waves beside its turns", "[balance]") {
  const OrbitMesh mesh = waves(24);
  Matrix turn(1, mesh.nodes());
  for (Index node = 0; node < mesh.nodes(); ++node) turn(0, node) = two_pi * mesh.place(node);
  const CycleStart start =
      cycle_from_orbit(std::make_shared<Rotor>(), mesh, turn, 6.5, Vector::Constant(1, 0.4));
  const Solution solution = solve(*start.problem, start.guess);
  REQUIRE(solution.outcome == Correction::converged);
  CHECK_THAT(solution.unknowns.tail(1)(0), WithinRel(two_pi / std::sqrt(1 - 0.16), 1e-12));
}

TEST_CASE("Relaxation is told where waves no longer hold it", "[balance]") {
  const auto field = std::make_shared<EquilibriumField>(van_der_pol());
  const OrbitMesh mesh = waves(8);
  const CycleStart start = cycle_from_orbit(field, mesh, circle(mesh, -2), 6.3, Vector::Constant(1, 0.2));
  const CycleBranch found =
      trace_cycles(start, over("mu", 0.2, 20), {.trigonometric = true, .most_waves = 32, .tolerance = 1e-6});
  CHECK(found.branch.stop == Stop::no_value);
  CHECK_THAT(found.branch.explanation, ContainsSubstring("an orbit of 32 waves misses more than"));
  CHECK(found.branch.points.back().parameters(0) > 1);
  CHECK(found.branch.points.back().parameters(0) < 5);
}

}  // namespace arcslip::testing::balanced
