#pragma once

// Brute force for stability: the monodromy matrix of x' = A(t) x by the classical Runge-Kutta method.

#include "arcslip/types.hpp"

namespace arcslip::testing {

/// x(period) from x(0) = 1. The error falls as steps^-4.
template <class Function>
Matrix monodromy(const Function& A, double period, int steps = 4000) {
  const double h = period / steps;
  Matrix x = Matrix::Identity(A(0.0).rows(), A(0.0).cols());
  for (int i = 0; i < steps; ++i) {
    const double t = i * h;
    const Matrix middle = A(t + h / 2);
    const Matrix k1 = A(t) * x;
    const Matrix k2 = middle * (x + h / 2 * k1);
    const Matrix k3 = middle * (x + h / 2 * k2);
    const Matrix k4 = A(t + h) * (x + h * k3);
    x += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
  }
  return x;
}

/// The largest distance of one of `wanted` from the nearest of `found`, which it takes.
inline double worst_match(const ComplexVector& wanted, ComplexVector found) {
  double worst = 0;
  for (const Complex& value : wanted) {
    if (found.size() == 0) return 1e300;
    Index nearest = 0;
    worst = std::max(worst, (found.array() - value).abs().minCoeff(&nearest));
    found(nearest) = found(found.size() - 1);
    found.conservativeResize(found.size() - 1);
  }
  return worst;
}

}  // namespace arcslip::testing
