#pragma once

// Polynomial systems whose special points are chosen. Along the branch x_1 = ... = 0, on which x_0 = y is the
// way,
//
//   x_0' = +-(p - P(y)), P' = (y - f_1) (y - f_2) ...            folds at y = f_j
//   x_k' = (y - b_k) x_k + c_k x_k^2 - x_k^3                      branch points at y = b_k
//   z_k' = (y - h_k + i omega_k) z_k - |z_k|^2 z_k                Hopf points at y = h_k, z_k two real
//   unknowns
//
// seen as u = Q^-1 x, with any matrix Q.

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <random>
#include <utility>
#include <vector>

#include "arcslip/dense.hpp"
#include "branches.hpp"

namespace arcslip::testing {

struct PolynomialSystem : continuation::Problem {
  std::vector<double> folds, branch_points, hopf_points, quadratic, omega;
  double sign = 1;
  bool equilibrium = false;
  Matrix to_x, from_x;  // Q and its inverse

  Index size() const override {
    return static_cast<Index>(1 + branch_points.size() + 2 * hopf_points.size());
  }
  bool is_equilibrium() const override { return equilibrium; }
  std::vector<std::string> parameter_names() const override { return {"p"}; }

  double slope(double y) const {
    double product = 1;
    for (const double fold : folds) product *= y - fold;
    return product;
  }

  /// P(y), from the coefficients of P'.
  double value(double y) const {
    std::vector<double> coefficients{1};
    for (const double fold : folds) {
      coefficients.push_back(0);
      for (std::size_t i = coefficients.size() - 1; i > 0; --i)
        coefficients[i] = coefficients[i - 1] - fold * coefficients[i];
      coefficients[0] *= -fold;
    }
    double sum = 0;
    for (std::size_t i = coefficients.size(); i-- > 0;)
      sum = sum * y + coefficients[i] / static_cast<double>(i + 1);
    return sum * y;
  }

  bool evaluate(const Vector& u, const Vector& p, const continuation::Regime& /*regime*/,
                const continuation::Evaluation& out) const override {
    const Vector x = to_x * u;
    const double y = x(0);
    Vector f(size());
    Matrix jacobian = Matrix::Zero(size(), size());
    f(0) = sign * (p(0) - value(y));
    jacobian(0, 0) = -sign * slope(y);
    Index k = 1;
    for (std::size_t i = 0; i < branch_points.size(); ++i, ++k) {
      const double z = x(k), away = y - branch_points[i];
      f(k) = away * z + quadratic[i] * z * z - z * z * z;
      jacobian(k, 0) = z;
      jacobian(k, k) = away + 2 * quadratic[i] * z - 3 * z * z;
    }
    for (std::size_t i = 0; i < hopf_points.size(); ++i, k += 2) {
      const double a = x(k), b = x(k + 1), w = omega[i];
      const double growth = y - hopf_points[i] - a * a - b * b;
      f(k) = growth * a - w * b;
      f(k + 1) = w * a + growth * b;
      jacobian(k, 0) = a;
      jacobian(k + 1, 0) = b;
      jacobian.block(k, k, 2, 2) << growth - 2 * a * a, -w - 2 * a * b, w - 2 * a * b, growth - 2 * b * b;
    }
    if (out.residual != nullptr) *out.residual = from_x * f;
    if (out.jacobian != nullptr) *out.jacobian = from_x * jacobian * to_x;
    if (out.parameter_jacobian != nullptr) *out.parameter_jacobian = from_x.col(0) * sign;
    return true;
  }
};

/// A point of the branch, by y.
using SpecialPoint = std::pair<double, continuation::PointType>;

struct RandomPolynomials {
  PolynomialSystem system;
  std::vector<SpecialPoint> special;  // by rising y, all between 0 and 2

  /// Two of the points lie 10^-1 to 10^-6 apart.
  explicit RandomPolynomials(unsigned seed) : draw_(seed) {
    const double first = uniform(0.2, 0.8);
    const double second = first + std::pow(10, -uniform(1, 6));
    switch (seed % 5) {
      case 0: branch_point(first), branch_point(second); break;
      case 1: fold(first), fold(second); break;
      case 2: hopf_point(first), hopf_point(second); break;
      case 3: branch_point(first), fold(second), branch_point(uniform(0, 1)); break;
      default: hopf_point(first), branch_point(second), fold(uniform(0, 1)); break;
    }
    for (auto more = draw_() % 3; more > 0; --more) branch_point(uniform(0, 1));
    if (system.folds.size() % 2 == 1) fold(uniform(1.5, 2));
    system.equilibrium = system.equilibrium || seed % 2 == 1;
    system.sign = draw_() % 2 == 1 || system.folds.empty() ? 1 : -1;
    mix();
    std::sort(special.begin(), special.end());
  }

  /// The branch from y = -1 to y = 2.5 or beyond.
  continuation::Branch trace() const {
    double low = system.value(-1), high = low;
    for (double y = -1; y <= 2.5; y += 1e-3) {
      low = std::min(low, system.value(y));
      high = std::max(high, system.value(y));
    }
    const Index n = system.size();
    continuation::Guess guess{-system.from_x.col(0), Vector::Constant(1, system.value(-1)), 0, Vector(n + 1)};
    guess.direction << system.from_x.col(0), system.slope(-1);
    return continuation::trace(system, guess, over("p", low - 1e-3, high + 1e-3));
  }

  std::vector<SpecialPoint> found(const continuation::Branch& branch) const {
    std::vector<SpecialPoint> points;
    for (const continuation::BranchPoint& point : branch.points) {
      using continuation::PointType;
      if (point.type == PointType::regular || point.type == PointType::start || point.type == PointType::end)
        continue;
      points.emplace_back((system.to_x * point.unknowns)(0), point.type);
    }
    std::sort(points.begin(), points.end());
    return points;
  }

 private:
  double uniform(double low, double high) {
    return low + (high - low) * std::uniform_real_distribution<double>()(draw_);
  }
  void fold(double y) {
    system.folds.push_back(y);
    special.emplace_back(y, continuation::PointType::fold);
  }
  void branch_point(double y) {
    system.branch_points.push_back(y);
    system.quadratic.push_back(draw_() % 2 == 1 ? 0 : uniform(-1, 1));
    special.emplace_back(y, continuation::PointType::branch_point);
  }
  void hopf_point(double y) {
    system.hopf_points.push_back(y);
    system.omega.push_back(uniform(0.3, 5));
    system.equilibrium = true;
    special.emplace_back(y, continuation::PointType::hopf);
  }
  void mix() {
    const Index n = system.size();
    Matrix any(n, n);
    for (double& entry : any.reshaped()) entry = uniform(-1, 1);
    Vector sizes(n);
    for (double& size : sizes) size = uniform(0.5, 2);
    system.to_x = sizes.asDiagonal() * orthonormal(any);
    system.from_x = system.to_x.inverse();
  }

  std::mt19937 draw_;
};

}  // namespace arcslip::testing
