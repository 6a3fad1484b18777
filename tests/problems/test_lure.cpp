// The cycle of the Lur'e system by harmonic balance.

#include <cmath>
#include <numbers>

#include "arcslip/continuation/path/newton.hpp"
#include "arcslip/structure/spectrum.hpp"
#include "catch.hpp"
#include "library_cases.hpp"
#include "monodromy.hpp"

using namespace arcslip;
using namespace arcslip::continuation;
using namespace arcslip::testing;

namespace {

double amplitude(const BranchPoint& point) { return point.unknowns(1); }
double period(const BranchPoint& point) { return 2 * pi / point.unknowns(point.unknowns.size() - 1); }

Branch cycles(const Instance& lure, double from, double to) {
  Branch branch = lure.trace(over("a", from, to));
  INFO(branch.explanation);
  REQUIRE(branch.complete());
  return branch;
}

/// The derivative of x of this order at t.
double motion(const Vector& u, double t, int order = 0) {
  const double w = u(u.size() - 1);
  double x = order == 0 ? u(0) : 0;
  for (Index k = 1; 2 * k < u.size() - 1; ++k) {
    const double v = static_cast<double>(k) * w;
    const double turn = v * t + order * pi / 2;
    x += std::pow(v, order) * (u(2 * k - 1) * std::cos(turn) + u(2 * k) * std::sin(turn));
  }
  return x;
}

ComplexVector brute_multipliers(const BranchPoint& point) {
  const auto variation = [&](double t) {
    const double slope = 2 * motion(point.unknowns, t) - 1;
    return Eigen::Matrix3d{{0, 1, 0}, {0, 0, 1}, {slope, -point.parameters(1), -point.parameters(0)}};
  };
  return spectrum(monodromy(variation, period(point), 2000));
}

}  // namespace

TEST_CASE("The Lur'e system's period doubling converges with the harmonics to that of collocation",
          "[lure][hill]") {
  struct Row {
    double harmonics, tolerance;
  };
  // with few harmonics the first ones that are left out count; then AUTO-07p's ten decimals do
  const Row row = GENERATE(values<Row>({{3, 1e-6}, {4, 5e-10}, {6, 6e-11}, {12, 6e-11}}));
  CAPTURE(row.harmonics);
  const Instance lure("lure", {{"harmonics", row.harmonics}});
  const Branch branch = cycles(lure, 0.999, 0.55);
  int doubled = 0;
  for (const BranchPoint& point : branch.points) {
    CAPTURE(point.parameters(0), point.eigenvalues);
    if (point.type == PointType::period_doubling) {
      ++doubled;
      CHECK_THAT(point.parameters(0), WithinAbs(0.6303020062, row.tolerance));
      CHECK_THAT(period(point), WithinAbs(6.3640713394, row.tolerance));
      CHECK(std::abs(point.eigenvalues(0)) < 1e-12);
    } else {
      CHECK((point.type == PointType::regular || point.type == PointType::start ||
             point.type == PointType::end));
      CHECK(point.unstable == doubled);
    }
    // Liouville, with the exponent 0 of the shift in time
    CHECK_THAT(point.eigenvalues.sum().real(), WithinAbs(-point.parameters(0), 1e-6));
  }
  CHECK(doubled == 1);
}

TEST_CASE("The Lur'e system's cycle is born at its Hopf point", "[lure]") {
  // By harmonic balance of second order A^2 = (1 - a)/0.9 and T = 2 pi (1 + (1 - a)/27).
  const Instance lure("lure");
  const Branch branch = cycles(lure, 0.9999, 0.999);
  const BranchPoint& first = branch.points.front();
  CHECK_THAT(amplitude(first) * amplitude(first), WithinRel(1e-4 / 0.9, 1e-3));  // the next order is 1 - a
  CHECK_THAT(period(first) - 2 * pi, WithinRel(2 * pi * 1e-4 / 27, 1e-3));
  CHECK_THAT(first.eigenvalues(1).real(), WithinAbs(-1, 1e-3));
}

TEST_CASE("The Lur'e system's cycles solve its equation at every time, with the multipliers of brute force",
          "[lure][hill]") {
  const Instance lure("lure", {{"harmonics", 10}});
  for (const BranchPoint& point : cycles(lure, 0.95, 0.6).points) {
    const double a = point.parameters(0);
    CAPTURE(a, point.eigenvalues);
    for (int i = 0; i < 50; ++i) {
      const double t = period(point) * i / 50;
      const auto x = [&](int order) { return motion(point.unknowns, t, order); };
      CHECK_THAT(x(3) + a * x(2) + x(1) + x(0) - x(0) * x(0), WithinAbs(0, 1e-9));  // harmonics beyond 10
    }
    const ComplexVector brute = brute_multipliers(point);
    ComplexVector found(3);  // by the rates alone all but the signs are known
    found << 1, (point.eigenvalues * period(point)).array().exp();
    CHECK(worst_match(brute.cwiseAbs(), found.cwiseAbs()) < 1e-9);  // 300 steps a radian, double at 1 nowhere
    if (point.type == PointType::period_doubling) CHECK((brute.array() + 1).abs().minCoeff() < 1e-9);
  }
}

TEST_CASE("The Lur'e system's guess leads to the cycle at any distance from its birth", "[lure]") {
  const double b = GENERATE(0.5, 1, 2);
  const double share = GENERATE(0.9999, 0.95, 0.6);  // of a = 1/b; at b = 1/2 the cycle ends at 0.53
  CAPTURE(b, share);
  const Instance lure("lure", {{"a", share / b}, {"b", b}});
  const Guess guess = lure.guess();
  const Solution solution = solve(*lure.problem, guess);
  REQUIRE(solution.outcome == Correction::converged);
  CHECK(solution.unknowns(1) > 0.5 * std::sqrt(1 - share));
  CHECK((solution.unknowns - guess.unknowns).norm() < (share < 0.99 ? 1e-8 : 1e-3));
}

TEST_CASE("The Lur'e system's x^2 is projected without aliasing", "[lure]") {
  // x = cos H t: x^2 = 1/2 and a harmonic that is not there. At w = 0 the residual is x - x^2.
  const double harmonics = GENERATE(1, 2, 5);
  const Instance lure("lure", {{"harmonics", harmonics}});
  const Index n = lure.problem->size();
  Vector residual(n);
  Evaluation out;
  out.residual = &residual;
  REQUIRE(lure.problem->evaluate(Vector::Unit(n, n - 3), Eigen::Vector2d(1, 1), 0, out));
  Vector exact = Vector::Unit(n, n - 3);
  exact(0) = -0.5;
  CHECK((residual - exact).lpNorm<Eigen::Infinity>() < 1e-15);
}
