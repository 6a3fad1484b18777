// Tori against closed forms.

#include <cmath>

#include "arcslip/continuation/cycles/torus_branch.hpp"
#include "arcslip/continuation/problem/derivative_check.hpp"
#include "branches.hpp"
#include "catch.hpp"
#include "flow.hpp"

namespace arcslip::testing::tori {

using namespace arcslip::continuation;

namespace {

/// A cycle z = e^(jt) and a motion w of growth q and rate nu beside it, x + jy and a + jb, in coordinates
/// that mix them: where q > 0 a torus of |z| = 1 and |w|^2 = q, with rates 1 + 0.3 q and nu + 0.1 q. Its q is
/// p (1 - p).
std::shared_ptr<const Problem> mixed() {
  return make_flow(4, {"p", "nu"}, [](const auto& u, const auto& p, auto& f) {
    const auto a = u[2];
    const auto b = u[3] - 0.1 * u[2] * u[2];
    const auto x = u[0] - 0.2 * a * a;
    const auto y = u[1] - 0.1 * x * a;
    const auto around = x * x + y * y;
    const auto beside = a * a + b * b;
    const auto turn = 1.0 + 0.3 * beside;
    const auto other = p[1] + 0.1 * beside;
    const auto growth = p[0] * (1.0 - p[0]) - beside;
    const auto dx = (1.0 - around) * x - turn * y;
    const auto dy = turn * x + (1.0 - around) * y;
    const auto da = growth * a - other * b;
    const auto db = other * a + growth * b;
    f[0] = dx + 0.4 * a * da;
    f[1] = dy + 0.1 * (dx * a + x * da);
    f[2] = da;
    f[3] = db + 0.2 * a * da;
  });
}

/// (x - g)' = (mu + j nu)(x - g) - (x - g) |x - g|^2 about a motion g of the period 2 pi/W: where mu > 0 the
/// torus of |x - g|^2 = mu.
class Driven : public Field {
 public:
  Index size() const override { return 2; }
  std::vector<std::string> names() const override { return {"x", "y"}; }
  std::vector<std::string> parameter_names() const override { return {"mu", "nu", "W"}; }
  bool is_periodic() const override { return true; }
  double period(const Vector& p, Vector* by_parameters) const override {
    if (by_parameters != nullptr) *by_parameters = Eigen::Vector3d(0, 0, -two_pi / (p(2) * p(2)));
    return two_pi / p(2);
  }
  [[nodiscard]] bool evaluate(double t, const Vector& u, const Vector& p,
                              const FieldValues& out) const override {
    using Number = Differentiated;
    const auto number = [](double value, Index which) { return Number(value, 6, which); };
    const Number time = number(t, 5);
    const Number mu = number(p(0), 2);
    const Number nu = number(p(1), 3);
    const Number rate = number(p(2), 4);
    const Number a = number(u(0), 0) - cos(rate * time) - 0.3 * cos(2.0 * rate * time);
    const Number b = number(u(1), 1) - 0.5 * sin(rate * time);
    const Number growth = mu - a * a - b * b;
    const Number f[] = {growth * a - nu * b - rate * sin(rate * time) - 0.6 * rate * sin(2.0 * rate * time),
                        nu * a + growth * b + 0.5 * rate * cos(rate * time)};
    for (Index i = 0; i < 2; ++i) {
      const auto& slopes = f[i].derivatives();
      if (out.velocity != nullptr) (*out.velocity)(i) = f[i].value();
      if (out.by_unknowns != nullptr) out.by_unknowns->row(i) = slopes.head(2).transpose();
      if (out.by_parameters != nullptr) out.by_parameters->row(i) = slopes.segment(2, 3).transpose();
      if (out.by_time != nullptr) (*out.by_time)(i) = slopes(5);
    }
    return true;
  }
};

OrbitMesh intervals() { return {CollocationRule(7), 24}; }

/// The cycle z of `mixed`, at w = 0.
CycleBranch cycles_of_mixed(const OrbitMesh& mesh, double to) {
  Matrix orbit = Matrix::Zero(4, mesh.nodes());
  for (Index node = 0; node < mesh.nodes(); ++node)
    orbit.col(node).head(2) << std::cos(two_pi * mesh.place(node)), std::sin(two_pi * mesh.place(node));
  const Vector p = Eigen::Vector2d(-0.4, std::sqrt(2.0) - 1);
  const CycleStart start =
      cycle_from_orbit(std::make_shared<EquilibriumField>(mixed()), mesh, orbit, two_pi, p);
  return trace_cycles(start, over("p", -0.4, to));
}

void check_mixed(const TorusBranch& torus, double margin) {
  Vector observed;
  for (const BranchPoint& point : torus.branch.points) {
    const double q = point.parameters(0) * (1 - point.parameters(0));
    INFO("at p = " << point.parameters(0));
    torus.problem->observe(point.unknowns, point.parameters, point.regime, observed);
    CHECK_THAT(observed(0), WithinAbs(1 + 0.3 * q, margin));
    CHECK_THAT(observed(1), WithinAbs(point.parameters(1) + 0.1 * q, margin));
    CHECK_THAT(observed(2), WithinAbs((point.parameters(1) + 0.1 * q) / (1 + 0.3 * q), margin));
    CHECK_THAT(observed(3), WithinAbs(1 + 0.2 * q, margin));
    CHECK_THAT(observed(4), WithinAbs(-1, margin));
    CHECK_THAT(observed(7), WithinAbs(std::sqrt(q), margin));
    CHECK_THAT(observed(8), WithinAbs(-std::sqrt(q), margin));
    CHECK_THAT(
        observed(11),
        WithinAbs(std::sqrt(1 + q + 0.04 * 3 * q * q / 8 + 0.01 * q / 4 + 0.01 * 3 * q * q / 8), margin));
    CHECK(point.unstable == -1);
  }
}

}  // namespace

TEST_CASE("A torus in mixed coordinates is that of two rates, from its birth to its end", "[tori][long]") {
  for (const bool balanced : {false, true}) {
    const OrbitMesh mesh = balanced ? OrbitMesh(CollocationRule::trigonometric(6), 1) : intervals();
    const std::vector<CycleBranch> cycles{cycles_of_mixed(mesh, 1.3)};
    const auto all = trace_tori_leaving(cycles, over("p", -0.4, 1.3), {.tolerance = 1e-9});
    REQUIRE(all.size() == 1);  // both of its ends are points of one branch of cycles
    const Branch& branch = all[0].branch;
    CHECK(branch.stop == Stop::left_regime);
    CHECK_THAT(branch.explanation, ContainsSubstring("the torus shrinks onto a cycle"));
    CHECK_THAT(branch.points.front().parameters(0), WithinAbs(0, 1e-4));
    CHECK_THAT(branch.points.back().parameters(0), WithinAbs(1, 1e-4));
    check_mixed(all[0], 1e-9);
  }
}

TEST_CASE("A torus of a load turns about its own motion", "[tori]") {
  const auto field = std::make_shared<Driven>();
  const OrbitMesh mesh = intervals();
  Matrix orbit(2, mesh.nodes());
  for (Index node = 0; node < mesh.nodes(); ++node) {
    const double angle = two_pi * mesh.place(node);
    orbit.col(node) << std::cos(angle) + 0.3 * std::cos(2 * angle), 0.5 * std::sin(angle);
  }
  const Vector p = Eigen::Vector3d(-0.3, 0.7, 1.9);
  const CycleBranch cycles =
      trace_cycles(cycle_from_orbit(field, mesh, orbit, two_pi / 1.9, p), over("mu", -0.3, 0.8));
  const auto all = trace_tori_leaving({cycles}, over("mu", -0.3, 0.8), {.tolerance = 1e-9});
  REQUIRE(all.size() == 1);
  CHECK(all[0].branch.stop == Stop::reached_end);
  Vector observed;
  for (const BranchPoint& point : all[0].branch.points) {
    const double radius = std::sqrt(point.parameters(0));
    all[0].problem->observe(point.unknowns, point.parameters, point.regime, observed);
    CHECK_THAT(observed(0), WithinRel(1.9, 1e-14));
    CHECK_THAT(observed(1), WithinAbs(0.7, 1e-9));
    CHECK_THAT(observed(3), WithinAbs(1.3 + radius, 1e-9));
    CHECK_THAT(observed(5), WithinAbs(0.5 + radius, 1e-9));
    CHECK_THAT(observed(7), WithinAbs(std::sqrt(0.5 + 0.045 + 0.125 + radius * radius), 1e-9));
  }
  const BranchPoint& end = all[0].branch.points.back();
  const DerivativeReport report = check_derivatives(*all[0].problem, end.unknowns, end.parameters, {});
  INFO(report.where);
  CHECK(report.worst < 1e-7);
}

TEST_CASE("Derivatives of a torus with two unknown rates are exact", "[tori]") {
  const auto all = trace_tori_leaving({cycles_of_mixed(intervals(), 0.3)}, over("p", -0.4, 0.3));
  REQUIRE(all.size() == 1);
  const BranchPoint& end = all[0].branch.points.back();
  const DerivativeReport report = check_derivatives(*all[0].problem, end.unknowns, end.parameters, {});
  INFO(report.where);
  CHECK(report.worst < 1e-7);
}

TEST_CASE("A torus that its waves no longer hold is told to end", "[tori][long]") {
  const auto all =
      trace_tori_leaving({cycles_of_mixed(intervals(), 0.3)}, over("p", -0.4, 0.3), {.tolerance = 1e-18});
  REQUIRE(all.size() == 1);
  CHECK(all[0].branch.stop == Stop::no_value);
  CHECK_THAT(all[0].branch.explanation,
             ContainsSubstring("waves misses more than 1e-18 of what its unknowns do"));
}

}  // namespace arcslip::testing::tori
