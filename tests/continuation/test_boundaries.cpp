#include <boost/math/quadrature/gauss.hpp>
#include <boost/math/special_functions/ellint_1.hpp>
#include <cmath>
#include <functional>
#include <unsupported/Eigen/AutoDiff>

#include "arcslip/continuation/cycles/boundary_problem.hpp"
#include "arcslip/continuation/path/newton.hpp"
#include "arcslip/continuation/problem/derivative_check.hpp"
#include "branches.hpp"
#include "catch.hpp"

using namespace arcslip;
using namespace arcslip::continuation;
using namespace arcslip::testing;

namespace {

using Number = Eigen::AutoDiffScalar<Vector>;
using Numbers = std::vector<Number>;

/// Written by functions of numbers that differentiate themselves: f(s, u, p, out), g(left, right, p, out).
class Written : public BoundaryField {
 public:
  using Rates = std::function<void(double s, const Numbers& u, const Numbers& p, Numbers& out)>;
  using Ends = std::function<void(const Numbers& left, const Numbers& right, const Numbers& p, Numbers& out)>;

  Written(std::vector<std::string> names, std::vector<std::string> parameters, Rates rates, Ends ends,
          Index told = -1, Index free = 0)
      : names_(std::move(names)),
        parameters_(std::move(parameters)),
        rates_(std::move(rates)),
        ends_(std::move(ends)),
        told_(told < 0 ? size() : told),
        free_(free) {}

  Index size() const override { return std::ssize(names_); }
  Index told() const override { return told_; }
  Index free() const override { return free_; }
  std::vector<std::string> names() const override { return names_; }
  std::vector<std::string> parameter_names() const override { return parameters_; }

  [[nodiscard]] bool evaluate(double t, const Vector& u, const Vector& p,
                              const FieldValues& out) const override {
    const Index count = u.size() + p.size();
    Numbers values = zeros(count);
    rates_(t, numbers(u, 0, count), numbers(p, u.size(), count), values);
    for (Index i = 0; i < size(); ++i) {
      const Number& value = values[static_cast<std::size_t>(i)];
      if (out.velocity != nullptr) (*out.velocity)(i) = value.value();
      if (out.by_unknowns != nullptr) out.by_unknowns->row(i) = value.derivatives().head(u.size());
      if (out.by_parameters != nullptr) out.by_parameters->row(i) = value.derivatives().tail(p.size());
    }
    return true;
  }

  [[nodiscard]] bool end_conditions(const Vector& left, const Vector& right, const Vector& p,
                                    const EndConditions& out) const override {
    const Index n = size();
    const Index count = 2 * n + p.size();
    Numbers values = zeros(count);
    ends_(numbers(left, 0, count), numbers(right, n, count), numbers(p, 2 * n, count), values);
    for (Index i = 0; i < n; ++i) {
      const Number& value = values[static_cast<std::size_t>(i)];
      if (out.values != nullptr) (*out.values)(i) = value.value();
      if (out.by_left != nullptr) out.by_left->row(i) = value.derivatives().head(n);
      if (out.by_right != nullptr) out.by_right->row(i) = value.derivatives().segment(n, n);
      if (out.by_parameters != nullptr) out.by_parameters->row(i) = value.derivatives().tail(p.size());
    }
    return true;
  }

 private:
  Numbers zeros(Index count) const {
    return Numbers(static_cast<std::size_t>(size()), Number(0.0, Vector::Zero(count)));
  }
  static Numbers numbers(const Vector& values, Index first, Index count) {
    Numbers all;
    for (Index i = 0; i < values.size(); ++i) all.emplace_back(values(i), count, first + i);
    return all;
  }

  std::vector<std::string> names_;
  std::vector<std::string> parameters_;
  Rates rates_;
  Ends ends_;
  Index told_;
  Index free_;
};

using Given = std::shared_ptr<const BoundaryField>;

void fixed_at_both(const Numbers& left, const Numbers& right, const Numbers& /*p*/, Numbers& out) {
  out[0] = left[0];
  out[1] = right[0];
}

/// u'' + lambda e^u = 0, u(0) = u(1) = 0.
Given bratu() {
  return std::make_shared<Written>(
      std::vector<std::string>{"u", "v"}, std::vector<std::string>{"lambda"},
      [](double /*s*/, const Numbers& u, const Numbers& p, Numbers& out) {
        out[0] = u[1];
        out[1] = -p[0] * exp(u[0]);
      },
      fixed_at_both);
}

/// With theta for the parameter, u = 2 ln(cosh(theta)/cosh(theta (1 - 2 s))).
double bratu_lambda(double theta) { return 8 * theta * theta / std::pow(std::cosh(theta), 2); }
double bratu_solution(double theta, double s) {
  return 2 * std::log(std::cosh(theta) / std::cosh(theta * (1 - 2 * s)));
}

/// u'' + lambda (u - u^3) = 0, u(0) = u(1) = 0: at (k pi)^2 branches leave u = 0.
Given buckling() {
  return std::make_shared<Written>(
      std::vector<std::string>{"u", "v"}, std::vector<std::string>{"lambda"},
      [](double /*s*/, const Numbers& u, const Numbers& p, Numbers& out) {
        out[0] = u[1];
        out[1] = -p[0] * (u[0] - u[0] * u[0] * u[0]);
      },
      fixed_at_both);
}

/// Bratu's problem with the mean of u given and lambda free.
Given given_mean() {
  return std::make_shared<Written>(
      std::vector<std::string>{"u", "v", "lambda", "so far"}, std::vector<std::string>{"mean"},
      [](double /*s*/, const Numbers& u, const Numbers& /*p*/, Numbers& out) {
        out[0] = u[1];
        out[1] = -u[2] * exp(u[0]);
        out[3] = u[0];
      },
      [](const Numbers& left, const Numbers& right, const Numbers& p, Numbers& out) {
        fixed_at_both(left, right, p, out);
        out[2] = left[3];
        out[3] = right[3] - p[0];
      },
      2, 1);
}

/// eps y'' + 2 (x - at) y' = 0, y(-1) = -1, y(1) = 1: erf((x - at)/sqrt(eps)) but for what the ends ask for;
/// eps = 10^(-2 c).
Given layer() {
  return std::make_shared<Written>(
      std::vector<std::string>{"y", "w"}, std::vector<std::string>{"c", "at"},
      [](double s, const Numbers& u, const Numbers& p, Numbers& out) {
        const Number inverse = exp(std::log(10.0) * p[0]);
        out[0] = 2.0 * inverse * u[1];
        out[1] = -4.0 * inverse * inverse * (2 * s - 1 - p[1]) * u[1];
      },
      [](const Numbers& left, const Numbers& right, const Numbers& /*p*/, Numbers& out) {
        out[0] = left[0] + 1.0;
        out[1] = right[0] - 1.0;
      });
}

/// theta by the slope at the left end, 4 theta tanh(theta).
double bratu_theta(double slope) {
  double theta = std::max(0.25 * slope, std::sqrt(0.25 * slope));
  for (int i = 0; i < 50; ++i) {
    theta -= (4 * theta * std::tanh(theta) - slope) /
             (4 * std::tanh(theta) + 4 * theta / std::pow(std::cosh(theta), 2));
  }
  return theta;
}

OrbitStart from_zero(const Given& field, const Vector& p, const OrbitOptions& options = {}) {
  return boundary_start(
      field, [&](double /*s*/) { return Vector(Vector::Zero(field->size())); }, p, options);
}

/// Largest error of Bratu's upper solution at theta at the ends of intervals.
double error_of_bratu(int degree, Index intervals, double theta) {
  OrbitOptions options{.intervals = intervals, .degree = degree};
  const OrbitStart start = boundary_start(
      bratu(),
      [&](double s) {
        return Vector(Eigen::Vector2d(bratu_solution(theta, s), 4 * theta * std::tanh(theta * (1 - 2 * s))));
      },
      Vector::Constant(1, bratu_lambda(theta)), options);
  const Solution solution = solve(*start.problem, start.guess);
  REQUIRE(solution.outcome == Correction::converged);
  const auto orbit = start.problem->orbit(solution.unknowns);
  double error = 0;
  for (Index j = 0; j <= intervals; ++j) {
    const double s = static_cast<double>(j) / static_cast<double>(intervals);
    error = std::max(error, std::abs(orbit(0, j * degree) - bratu_solution(theta, s)));
  }
  return error;
}

}  // namespace

TEST_CASE("Bratu's branch is that of the closed form", "[boundaries]") {
  const OrbitOptions options{.intervals = 40};
  const OrbitBranch traced =
      trace_orbits(from_zero(bratu(), Vector::Constant(1, 0.5), options), over("lambda", 0.5, 4), options);
  const Branch& branch = traced.branch;
  INFO(branch.explanation);
  CHECK(branch.points.back().parameters(0) == 0.5);
  const auto folds = of_type(branch, PointType::fold);
  REQUIRE(folds.size() == 1);
  double theta = 1.2;  // theta tanh(theta) = 1
  for (int i = 0; i < 50; ++i)
    theta -= (theta * std::tanh(theta) - 1) / (std::tanh(theta) + theta / std::pow(std::cosh(theta), 2));
  CHECK_THAT(folds[0].parameters(0), WithinRel(bratu_lambda(theta), 1e-9));
  for (const BranchPoint& point : branch.points) {
    const auto orbit = traced.problem->orbit(point.unknowns);
    const double at = bratu_theta(orbit(1, 0));
    CHECK_THAT(point.parameters(0), WithinRel(bratu_lambda(at), 1e-9));
    const Vector places = traced.problem->times(point.unknowns, point.parameters, point.regime);
    for (Index j = 0; j <= traced.problem->intervals(); ++j) {
      const Index node = j * traced.problem->degree();
      CHECK_THAT(orbit(0, node), WithinAbs(bratu_solution(at, places(node)), 1e-9));
    }
  }
}

TEST_CASE("Errors at the ends of intervals are of order 2 m", "[boundaries]") {
  const auto degree = GENERATE(2, 3, 4);
  const Index count = degree == 2 ? 16 : 8;
  const double ratio = error_of_bratu(degree, count, 2) / error_of_bratu(degree, 2 * count, 2);
  CHECK_THAT(std::log2(ratio), WithinAbs(2 * degree, 0.3));
}

TEST_CASE("Derivatives of boundary value problems are exact", "[boundaries]") {
  const OrbitStart start = boundary_start(
      given_mean(), [](double s) { return Vector(Eigen::Vector4d(s * (1.1 - s), 1 - 2 * s, 0.7, 0.1 * s)); },
      Vector::Constant(1, 0.2), {.intervals = 5, .degree = 3});
  const DerivativeReport report =
      check_derivatives(*start.problem, start.guess.unknowns, start.guess.parameters, {});
  INFO(report.where);
  CHECK(report.worst < 1e-6);
}

TEST_CASE("Branches leave a column at each of its loads", "[boundaries]") {
  const auto all =
      trace_connected_orbits(from_zero(buckling(), Vector::Constant(1, 1)), over("lambda", 1, 100));
  REQUIRE(all.size() == 4);
  const auto loads = of_type(all[0].branch, PointType::branch_point);
  REQUIRE(loads.size() == 3);
  for (int k = 1; k <= 3; ++k) {
    const double load = k * k * pi * pi;
    CHECK_THAT(loads[static_cast<std::size_t>(k - 1)].parameters(0), WithinRel(load, 1e-9));
    const OrbitBranch& bent = all[static_cast<std::size_t>(k)];
    REQUIRE(bent.branch.points.size() > 10);
    CHECK(bent.branch.points.front().parameters(0) == 100);
    CHECK(bent.branch.points.back().parameters(0) == 100);
    for (const BranchPoint& point : bent.branch.points) {  // u = a sn(2 k K s), a^2 = 2 m/(1 + m)
      Vector observed;
      bent.problem->observe(point.unknowns, point.parameters, point.regime, observed);
      const double square = std::pow(std::max(observed(0), -observed(1)), 2);
      const double m = square / (2 - square);
      const double omega = 2 * k * boost::math::ellint_1(std::sqrt(m));
      CHECK_THAT(point.parameters(0), WithinRel(omega * omega * (1 + m), 1e-6));
    }
  }
}

TEST_CASE("Branch points of a state of rest are all found, on meshes that hold what leaves them",
          "[boundaries]") {
  const OrbitBranch traced =
      trace_orbits(from_zero(buckling(), Vector::Constant(1, 1)), over("lambda", 1, 4200));
  INFO(traced.branch.explanation);
  const auto found = of_type(traced.branch, PointType::branch_point);
  REQUIRE(found.size() == 20);  // the last ones lie less than a step apart
  for (std::size_t i = 0; i < found.size(); ++i) {
    const double wave = pi * static_cast<double>(i + 1);
    CHECK_THAT(found[i].parameters(0), WithinRel(wave * wave, 1e-9));
  }
}

TEST_CASE("An integral that is given frees a parameter", "[boundaries]") {
  const OrbitOptions options{.intervals = 40};
  const OrbitBranch traced =
      trace_orbits(from_zero(given_mean(), Vector::Constant(1, 0.1), options), over("mean", 0.1, 3), options);
  INFO(traced.branch.explanation);
  CHECK(traced.branch.complete());
  CHECK(of_type(traced.branch, PointType::fold).empty());
  const std::vector<std::string> names = observable_names(*traced.problem);
  CHECK(names == std::vector<std::string>{"lambda", "u_max", "u_min", "v_max", "v_min", "norm", "u_left",
                                          "u_right", "v_left", "v_right"});
  double greatest = 0;
  for (const BranchPoint& point : traced.branch.points) {
    Vector observed;
    traced.problem->observe(point.unknowns, point.parameters, point.regime, observed);
    const double theta = bratu_theta(observed(8));
    CHECK_THAT(observed(0), WithinRel(bratu_lambda(theta), 1e-9));
    const double mean = boost::math::quadrature::gauss<double, 30>::integrate(
        [&](double s) { return bratu_solution(theta, s); }, 0.0, 1.0);
    CHECK_THAT(point.parameters(0), WithinRel(mean, 1e-9));
    greatest = std::max(greatest, observed(0));
  }
  CHECK_THAT(greatest, WithinAbs(3.5138, 0.05));  // there is no fold to land on
}

TEST_CASE("A mesh follows a layer as it narrows and as it moves", "[boundaries]") {
  const OrbitStart wide = from_zero(layer(), Eigen::Vector2d(0, -0.5));
  const OrbitBranch narrow = trace_orbits(wide, over("c", 0, 3));
  INFO(narrow.branch.explanation);
  REQUIRE(narrow.branch.complete());
  CHECK(narrow.problem->intervals() <= 320);
  const BranchPoint& last = narrow.branch.points.back();
  const OrbitFrame& frame = narrow.problem->frame(last.regime);
  const OrbitMesh even(frame.mesh.rule(), 2560);
  CHECK(even.errors(frame.mesh.carried(narrow.problem->orbit(last.unknowns), even), frame.range).maxCoeff() >
        1e-6);

  const OrbitBranch begun = trace_orbits(wide, over("c", 0, 1.5));
  REQUIRE(begun.branch.complete());
  const BranchPoint& end = begun.branch.points.back();
  const Matrix still = begun.problem->orbit(end.unknowns);
  const OrbitBranch moved = trace_orbits(
      start_from(begun.problem->about(begun.problem->frame(end.regime).mesh, still, end.parameters), still, 1,
                 end.parameters),
      over("at", -0.5, 0.5));
  INFO(moved.branch.explanation);
  REQUIRE(moved.branch.complete());
  CHECK(moved.problem->intervals() <= 80);
  const auto check = [](const OrbitBranch& traced) {
    for (const BranchPoint& point : traced.branch.points) {
      const double width = std::pow(10, -point.parameters(0));
      const auto part = [&](double x) { return std::erf((x - point.parameters(1)) / width); };
      const auto orbit = traced.problem->orbit(point.unknowns);
      const Vector places = traced.problem->times(point.unknowns, point.parameters, point.regime);
      double error = 0;
      for (Index node = 0; node < orbit.cols(); ++node) {
        const double x = 2 * places(node) - 1;
        const double exact = 2 * (part(x) - part(-1)) / (part(1) - part(-1)) - 1;
        error = std::max(error, std::abs(orbit(0, node) - exact));
      }
      CHECK(error < 2e-6);
    }
  };
  check(narrow);
  check(moved);
}
