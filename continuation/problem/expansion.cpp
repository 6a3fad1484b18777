#include "arcslip/continuation/problem/expansion.hpp"

#include <cmath>

#include "arcslip/dense.hpp"

namespace arcslip::continuation {
namespace {

constexpr Index points = 10;

/// Chebyshev's on (-1, 1).
Vector places() {
  Vector x(points);
  for (Index i = 0; i < points; ++i)
    x(i) = std::cos(pi * (static_cast<double>(i) + 0.5) / static_cast<double>(points));
  return x;
}

/// Of values there to the coefficients of the polynomial through them, lowest first.
Matrix to_coefficients(const Vector& x) {
  Matrix powers = Matrix::Ones(points, points);
  for (Index k = 1; k < points; ++k) powers.col(k) = powers.col(k - 1).cwiseProduct(x);
  return inverse_of(powers).value();
}

/// u(h), or u'(h).
Vector value_of(const Matrix& u, double h, bool derivative) {
  Vector value = Vector::Zero(u.rows());
  for (Index k = u.cols(); k-- > (derivative ? 1 : 0);)
    value = h * value + (derivative ? static_cast<double>(k) : 1) * u.col(k);
  return value;
}

}  // namespace

Expansion::Expansion(const Problem& problem, double reach)
    : problem_(problem),
      reach_(reach),
      at_(problem),
      scale_(problem.size()),
      parameter_scale_(static_cast<Index>(problem.parameter_names().size())) {}

bool Expansion::along(const Matrix& u, const Vector& p, const Regime& regime, Matrix& out) {
  if (!is_approximate_ && problem_.series(u, p, regime, out)) return out.allFinite();
  is_approximate_ = true;
  return interpolate(u, p, regime, out);
}

bool Expansion::interpolate(const Matrix& u, const Vector& p, const Regime& regime, Matrix& out) {
  const Vector x = places();
  problem_.scale(u.col(0), p, scale_, parameter_scale_);
  const double length = u.col(1).cwiseQuotient(scale_).lpNorm<Eigen::Infinity>();
  if (!(length > 0)) return false;
  const double h = reach_ / length;
  constexpr bool by_parameters = false;
  Matrix rates(u.rows(), points);
  Vector rate(u.rows());
  for (Index i = 0; i < points; ++i) {
    if (!at_.evaluate(value_of(u, h * x(i), false), p, regime, by_parameters)) return false;
    at_.multiply(value_of(u, h * x(i), true), rate);
    rates.col(i) = rate;
  }
  out.setZero(u.rows(), u.cols());
  const Matrix coefficients = rates * to_coefficients(x).transpose();
  for (Index k = 1; k < u.cols(); ++k)
    out.col(k) = coefficients.col(k - 1) / (static_cast<double>(k) * std::pow(h, k - 1));
  return out.allFinite();
}

}  // namespace arcslip::continuation
