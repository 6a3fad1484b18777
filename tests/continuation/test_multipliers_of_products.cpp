// Multipliers of products of matrices: their digits, and how known ones are taken out.

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "arcslip/continuation/cycles/floquet.hpp"
#include "catch.hpp"

using namespace arcslip;
using namespace arcslip::continuation;
using Catch::Matchers::WithinAbs;

TEST_CASE("Multipliers keep their digits over forty decades", "[cycles]") {
  const Index n = 5;
  const int factors = 12;
  const ComplexVector wanted =
      (ComplexVector(5) << Complex(46, 0), Complex(3, 1), Complex(3, -1), Complex(-2, pi), Complex(-46, 0))
          .finished();
  // each factor is S_(j+1) D S_j^-1 with D a twelfth of the exponents
  Matrix step = Matrix::Zero(n, n);
  step(0, 0) = std::exp(46.0 / factors);
  const double size = std::exp(3.0 / factors);
  step.block<2, 2>(1, 1) << size * std::cos(1.0 / factors), size * std::sin(1.0 / factors),
      -size * std::sin(1.0 / factors), size * std::cos(1.0 / factors);
  step(3, 3) = std::exp(-2.0 / factors);
  step(4, 4) = std::exp(-46.0 / factors);
  std::vector<Matrix> product;
  std::vector<Matrix> frames;
  for (int j = 0; j < factors; ++j) {
    Matrix frame = Matrix::Identity(n, n);
    for (Index i = 0; i < n; ++i) {
      for (Index k = 0; k < n; ++k) frame(i, k) += 0.2 * std::sin(1.0 + i + 2.3 * k + 1.7 * j);
    }
    frames.push_back(frame);
  }
  for (int j = 0; j < factors; ++j) {
    Matrix here = step;
    if (j == 0) here.row(3) *= -1;  // the fourth turns round once
    const Matrix& before = frames[static_cast<std::size_t>(j)];
    const Matrix& after = frames[static_cast<std::size_t>((j + 1) % factors)];
    product.emplace_back(after * here * before.inverse());
  }
  const ComplexVector found = log_multipliers(product);
  REQUIRE(found.size() == n);
  for (const Complex& log : wanted) {
    const double nearest = (found.array() - log).abs().minCoeff();
    INFO(log);
    CHECK(nearest < 1e-10);
  }
}

TEST_CASE("Equal multipliers hide no smaller ones", "[cycles]") {
  const Index n = 7;
  const int factors = 40;
  const Vector wanted = (Vector(n) << -4.8, -66.8, -66.8, -70.8, -70.8, -97.5, -102.9).finished();
  // each factor is S_(j+1) D_j S_j^-1, where equal ones grow and shrink alike on their way
  const auto frame = [&](int j) {
    Matrix result = Matrix::Identity(n, n);
    for (Index i = 0; i < n; ++i) {
      for (Index k = 0; k < n; ++k)
        result(i, k) += 0.2 * std::sin(1.0 + i + 2.3 * k + 1.7 * (j % factors)) / (1 + k);
    }
    return result;
  };
  std::vector<Matrix> product;
  for (int j = 0; j < factors; ++j) {
    Vector rates = wanted / factors;
    for (Index k = 0; k < n; ++k) rates(k) += std::sin(2 * pi * j / factors + std::ceil(0.5 * k));
    product.emplace_back(frame(j + 1) * rates.array().exp().matrix().asDiagonal() * frame(j).inverse());
  }
  const ComplexVector found = log_multipliers(product);
  REQUIRE(found.size() == n);
  std::vector<double> logs;
  for (const Complex& log : found) logs.push_back(log.real());
  std::sort(logs.begin(), logs.end(), std::greater<>());
  for (Index k = 0; k < n; ++k) CHECK_THAT(logs[static_cast<std::size_t>(k)], WithinAbs(wanted(k), 1e-10));
}

TEST_CASE("Known multipliers are taken out beside equal ones that rounding has made a pair", "[cycles]") {
  const auto without = [](ComplexVector logs, Complex log) {
    remove_multiplier(logs, log);
    return logs;
  };
  constexpr double parted = 1e-8;  // the root of rounding
  const Complex other(-0.3, 0);
  const auto pair_at = [&](double angle) {
    return (ComplexVector(3) << other, Complex(0, angle - parted), Complex(0, parted - angle)).finished();
  };
  for (const double angle : {parted + parted, pi}) {  // at 1 and at -1
    const ComplexVector left = without(pair_at(angle), Complex(0, angle == pi ? pi : 0));
    REQUIRE(left.size() == 2);
    CHECK(std::abs(left(0) - other) < 1e-15);
    CHECK(left(1).real() == 0);
    CHECK(std::abs(left(1).imag()) == (angle == pi ? pi : 0));
  }
  const ComplexVector split =
      (ComplexVector(3) << other, Complex(parted, pi), Complex(-parted, pi)).finished();
  const ComplexVector left = without(without(split, Complex(0, pi - parted)), Complex(0, parted - pi));
  REQUIRE(left.size() == 1);
  CHECK(std::abs(left(0) - other) < 1e-15);
}
