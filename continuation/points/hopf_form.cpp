#include "arcslip/continuation/points/hopf_form.hpp"

#include <Eigen/LU>
#include <array>
#include <cmath>

#include "arcslip/continuation/linear/eigenvalues.hpp"
#include "arcslip/continuation/problem/linearization.hpp"
#include "arcslip/continuation/problem/second_derivative.hpp"

namespace arcslip::continuation {
namespace {

/// Derivatives of F at a point along real directions.
class Derivatives {
 public:
  Derivatives(const Problem& problem, const Guess& at) : at_(at), linearization_(problem), second_(problem) {
    none_ = Vector::Zero(at.parameters.size());
  }

  bool linear(Matrix& a) {
    if (!linearization_.evaluate(at_.unknowns, at_.parameters, at_.regime)) return false;
    a = linearization_.jacobian();
    return true;
  }

  /// B(v, w) for two w: [B(v, first), B(v, second)].
  bool second(const Vector& v, const Vector& first, const Vector& second, std::array<Vector, 2>& products) {
    const Index n = v.size();
    Vector both;
    Vector one;
    const auto moved = [&](double h, Vector& out) {
      if (!linearization_.evaluate(at_.unknowns + h * v, at_.parameters, at_.regime)) return false;
      out.resize(2 * n);
      linearization_.multiply(first, one);
      out.head(n) = one;
      linearization_.multiply(second, one);
      out.tail(n) = one;
      return true;
    };
    one.resize(n);
    if (!std::isfinite(differentiate(moved, step(v), both).error)) return false;
    products = {both.head(n), both.tail(n)};
    return true;
  }

  /// w^T B(v, .), n x 2 for the two columns w.
  bool contracted(const Vector& v, const Matrix& weights, Matrix& rows) {
    if (!second_.contract(at_.unknowns, at_.parameters, at_.regime, weights, v, none_, rows)) return false;
    rows.conservativeResize(v.size(), Eigen::NoChange);
    return true;
  }

  /// w^T C(v, v, v) for the two columns w.
  bool third(const Vector& v, const Matrix& weights, Vector& products) {
    const auto moved = [&](double h, Vector& out) {
      Matrix rows;
      if (!second_.contract(at_.unknowns + h * v, at_.parameters, at_.regime, weights, v, none_, rows))
        return false;
      out = rows.topRows(v.size()).transpose() * v;
      return true;
    };
    return std::isfinite(differentiate(moved, step(v), products).error);
  }

 private:
  double step(const Vector& v) {
    constexpr double first = 0.02;  // of the scale
    const double length = second_.length(at_.unknowns, at_.parameters, v, none_);
    return length > 0 ? first / length : first;
  }

  const Guess& at_;
  Linearization linearization_;
  SecondDerivative second_;
  Vector none_;
};

/// The vector of the eigenvalue nearest to j omega, of length 1; omega becomes its imaginary part.
ComplexVector vector_at(const Matrix& a, double sign, double& omega) {
  ComplexMatrix vectors;
  const ComplexVector values = eigenvalues(a, &vectors);
  Index best = -1;
  for (Index i = 0; i < values.size(); ++i) {
    if (!(sign * values(i).imag() > 0)) continue;
    const auto away = [&](Index k) {
      return omega > 0 ? std::abs(values(k) - Complex(0, sign * omega)) : std::abs(values(k).real());
    };
    if (best < 0 || away(i) < away(best)) best = i;
  }
  if (best < 0) return {};
  omega = std::abs(values(best).imag());
  return vectors.col(best).normalized();
}

}  // namespace

std::optional<HopfForm> hopf_form(const Problem& problem, const Guess& hopf, double omega) {
  if (problem.sparse()) return std::nullopt;
  Derivatives derivatives(problem, hopf);
  Matrix a;
  if (!derivatives.linear(a)) return std::nullopt;
  const ComplexVector q = vector_at(a, 1, omega);
  if (q.size() == 0) return std::nullopt;
  double same = omega;
  ComplexVector p = vector_at(a.transpose(), -1, same);
  p /= std::conj(p.dot(q));  // p^H q = 1

  const Vector real = q.real();
  const Vector imaginary = q.imag();
  std::array<Vector, 2> by_real;
  std::array<Vector, 2> by_imaginary;
  if (!derivatives.second(real, real, imaginary, by_real) ||
      !derivatives.second(imaginary, real, imaginary, by_imaginary))
    return std::nullopt;
  const Vector steady = by_real[0] + by_imaginary[1];  // B(q, q*)
  ComplexVector turning(q.size());                     // B(q, q)
  turning.real() = by_real[0] - by_imaginary[1];
  turning.imag() = by_real[1] + by_imaginary[0];
  const Vector mean = a.partialPivLu().solve(steady);
  ComplexMatrix twice = -a.cast<Complex>();
  twice.diagonal().array() += Complex(0, 2 * omega);
  const ComplexVector second = twice.partialPivLu().solve(turning);

  Matrix weights(q.size(), 2);
  weights << p.real(), p.imag();
  Matrix along_real;
  Matrix along_imaginary;
  if (!derivatives.contracted(real, weights, along_real) ||
      !derivatives.contracted(imaginary, weights, along_imaginary))
    return std::nullopt;
  const auto times_p = [](const auto& products) { return Complex(products(0), -products(1)); };  // p^H
  const auto product = [&](const Matrix& along, const ComplexVector& y) {
    return times_p(Vector(along.transpose() * y.real())) +
           Complex(0, 1) * times_p(Vector(along.transpose() * y.imag()));
  };
  std::array<Vector, 4> cubes;  // of C(v, v, v) along Re q, Im q, their sum and their difference
  const std::array<Vector, 4> directions{real, imaginary, real + imaginary, real - imaginary};
  for (std::size_t i = 0; i < 4; ++i) {
    if (!derivatives.third(directions[i], weights, cubes[i])) return std::nullopt;
  }
  const Vector mixed = (cubes[2] + cubes[3] - 2 * cubes[0]) / 6;  // C(Re, Im, Im)
  const Vector other = (cubes[2] - cubes[3] - 2 * cubes[1]) / 6;  // C(Re, Re, Im)
  const Complex cubic = times_p(Vector(cubes[0] + mixed)) + Complex(0, 1) * times_p(Vector(cubes[1] + other));
  const ComplexVector still = mean.cast<Complex>();
  const Complex by_mean = product(along_real, still) + Complex(0, 1) * product(along_imaginary, still);
  const Complex by_second = product(along_real, second) - Complex(0, 1) * product(along_imaginary, second);
  const double terms = std::abs(cubic) + 2 * std::abs(by_mean) + std::abs(by_second);
  return HopfForm{omega, 0.5 * (cubic - 2.0 * by_mean + by_second).real() / omega, 0.5 * terms / omega};
}

}  // namespace arcslip::continuation
