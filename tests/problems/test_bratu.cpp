// Bratu's problem on an interval, which has a solution in closed form, and on a square.

#include <cmath>

#include "arcslip/continuation/points/normal_form.hpp"
#include "catch.hpp"
#include "library_cases.hpp"

using namespace arcslip;
using namespace arcslip::continuation;
using namespace arcslip::testing;

namespace {

double fold_parameter() {
  double s = 1.2;  // s tanh s = 1 by Newton's method
  for (int i = 0; i < 20; ++i) {
    const double t = std::tanh(s);
    s -= (s * t - 1) / (t + s * (1 - t * t));
  }
  return 8 * s * s / (std::cosh(s) * std::cosh(s));
}

/// A value on meshes that are halved each time, extrapolated in h^2, h^4, ... to h = 0.
double extrapolated(std::vector<double> values) {
  for (double factor = 4; values.size() > 1; factor *= 4) {
    for (std::size_t i = 0; i + 1 < values.size(); ++i)
      values[i] = (factor * values[i + 1] - values[i]) / (factor - 1);
    values.pop_back();
  }
  return values[0];
}

/// Orders in h of the errors of values on meshes that are halved each time.
std::vector<double> orders(const std::vector<double>& values, double limit) {
  std::vector<double> result;
  for (std::size_t i = 0; i + 1 < values.size(); ++i)
    result.push_back(std::log2(std::abs((values[i] - limit) / (values[i + 1] - limit))));
  return result;
}

BranchPoint fold_of(const Instance& instance, double to) {
  TraceOptions options = over("lambda", 0, to);
  options.stop_after = {{PointType::fold, 1, ""}};
  const Branch branch = instance.trace(options);
  INFO(branch.explanation);
  REQUIRE(branch.stop == Stop::requested);
  const BranchPoint fold = of_type(branch, PointType::fold).at(0);
  CHECK(defining_residual(*instance.problem, 0, fold) <= 1e-10);
  return fold;
}

double observed(const Instance& instance, const BranchPoint& point, Index which) {
  Vector values;
  instance.problem->observe(point.unknowns, point.parameters, 0, values);
  return values(which);
}

/// Largest relative difference between exact derivatives of a sparse problem, as products with a direction,
/// and differences. At steps of 1e-4 these are good to 1e-16/1e-4 and, extrapolated, to 1e-4^4.
double derivative_error(const Problem& problem, const Vector& u, const Vector& p) {
  const Vector du = (u.array() * 7).sin() + 0.3;
  const Index n = u.size();
  Vector residual(n);
  SparseMatrix jacobian(n, n);
  Matrix by_parameter(n, p.size());
  Evaluation all;
  all.residual = &residual;
  all.sparse_jacobian = &jacobian;
  all.parameter_jacobian = &by_parameter;
  REQUIRE(problem.evaluate(u, p, 0, all));
  REQUIRE(jacobian.isCompressed());
  const Vector exact = jacobian * du + by_parameter.col(0);
  const auto central = [&](double h) -> Vector {
    Vector ahead(n), behind(n);
    Evaluation out;
    out.residual = &ahead;
    problem.evaluate(u + h * du, p.array() + h, 0, out);
    out.residual = &behind;
    problem.evaluate(u - h * du, p.array() - h, 0, out);
    return (ahead - behind) / (2 * h);
  };
  const Vector difference = (4 * central(1e-4) - central(2e-4)) / 3;
  return (difference - exact).cwiseQuotient((1 + exact.array().abs()).matrix()).lpNorm<Eigen::Infinity>();
}

/// The same of the gradients of its observables, which are linear.
double gradient_error(const Problem& problem, const Vector& u, const Vector& p) {
  double worst = 0;
  Gradient gradient{Vector(u.size()), Vector(p.size())};
  Vector ahead, behind;
  const Vector du = (u.array() * 7).sin() + 0.3;
  problem.observe(u + du, p.array() + 1, 0, ahead);
  problem.observe(u - du, p.array() - 1, 0, behind);
  for (Index k = 0; k < static_cast<Index>(problem.observables().size()); ++k) {
    problem.observe(u, p, 0, k, gradient);
    const double exact = gradient.unknowns.dot(du) + gradient.parameters.sum();
    worst = std::max(worst, std::abs((ahead(k) - behind(k)) / 2 - exact) / (1 + std::abs(exact)));
  }
  return worst;
}

}  // namespace

TEST_CASE("Bratu's problems have exact derivatives", "[library]") {
  const std::string name = GENERATE("bratu", "bratu_2d");
  const double intervals = GENERATE(2, 7, 8);
  const Instance instance(name, {{"intervals", intervals}});
  const Vector u = Vector::LinSpaced(instance.problem->size(), 0.2, 1.1);
  const Vector p = Vector::Constant(1, 1.7);
  CHECK(derivative_error(*instance.problem, u, p) < 1e-10);
  CHECK(gradient_error(*instance.problem, u, p) < 1e-14);
}

TEST_CASE("Bratu's fold on an interval converges with h^2 to its closed form", "[library]") {
  const double limit = fold_parameter();
  CHECK_THAT(limit, WithinRel(3.51383071912516, 1e-14));
  std::vector<double> folds, heights;
  for (const double intervals : {20, 40, 80, 160}) {
    const Instance instance("bratu", {{"intervals", intervals}});
    const BranchPoint fold = fold_of(instance, 4);
    folds.push_back(fold.parameters(0));
    heights.push_back(observed(instance, fold, 0));
  }
  // the order differs from 2 by a term of h^2, 0.0025 on the coarsest mesh
  for (const double order : orders(folds, limit)) CHECK_THAT(order, WithinAbs(2, 0.01));
  for (const double order : orders(heights, 1.1868421686343886)) CHECK_THAT(order, WithinAbs(2, 0.01));
  // what three extrapolations leave is of h^8: 1e-10; the folds themselves are solved to 1e-12
  CHECK_THAT(extrapolated(folds), WithinRel(limit, 1e-9));
  CHECK_THAT(extrapolated(heights), WithinRel(1.1868421686343886, 1e-9));
}

TEST_CASE("Bratu's solutions on an interval converge to those in closed form on both halves", "[library]") {
  // lambda = 8 (s/cosh s)^2, u(1/2) = 2 ln cosh s, u'(0) = 4 s tanh s
  const double heights[2][3] = {{0.140539214400, 0.328952421341, 0.640146696041},
                                {4.091467246189, 2.895531265493, 1.975266971163}};
  const auto slope_of = [](double height) {
    const double s = std::acosh(std::exp(0.5 * height));
    return 4 * s * std::tanh(s);
  };
  std::vector<double> found_heights[2][3], found_slopes[2][3];
  for (const double intervals : {40, 80, 160, 320}) {
    const Instance instance("bratu", {{"intervals", intervals}});
    TraceOptions options = over("lambda", 0, 4);
    options.stop_at = {1, 2, 3};
    options.stop_after = {{PointType::user, 6, ""}};
    const auto points = of_type(instance.trace(options), PointType::user);
    REQUIRE(points.size() == 6);
    for (std::size_t i = 0; i < 6; ++i) {
      const std::size_t half = i < 3 ? 0 : 1;
      const std::size_t k = half == 0 ? i : 5 - i;
      CHECK(points[i].parameters(0) == static_cast<double>(k + 1));
      found_heights[half][k].push_back(observed(instance, points[i], 0));
      found_slopes[half][k].push_back(observed(instance, points[i], 1));
    }
  }
  for (std::size_t half = 0; half < 2; ++half) {
    for (std::size_t k = 0; k < 3; ++k) {
      CAPTURE(half, k);
      // steep solutions leave more after three extrapolations: (8 h)^8 on the coarsest mesh
      CHECK_THAT(extrapolated(found_heights[half][k]), WithinRel(heights[half][k], 1e-8));
      CHECK_THAT(extrapolated(found_slopes[half][k]), WithinRel(slope_of(heights[half][k]), 1e-6));
    }
  }
}

TEST_CASE("Bratu's fold on a square converges with h^2 to its published value", "[library][numbers]") {
  const double limit = 6.808124423;  // Boyd, J. Sci. Comput. 1 (1986) 183
  std::vector<double> folds, heights;
  for (const double intervals : {16, 32, 64, 128}) {
    const Instance instance("bratu_2d", {{"intervals", intervals}});
    const BranchPoint fold = fold_of(instance, 8);
    folds.push_back(fold.parameters(0));
    heights.push_back(observed(instance, fold, 0));
  }
  // the order differs from 2 by a term of h^2, 0.02 on the coarsest mesh
  for (const double order : orders(folds, limit)) CHECK_THAT(order, WithinAbs(2, 0.03));
  CHECK_THAT(extrapolated(folds), WithinRel(limit, 1e-9));  // published to ten digits
  // the centre's height from any three meshes is the same to a term of h^6
  CHECK_THAT(extrapolated({heights[0], heights[1], heights[2]}), WithinRel(extrapolated(heights), 1e-8));
}
