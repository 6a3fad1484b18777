#include "arcslip/continuation/points/hopf_form.hpp"

#include <Eigen/LU>
#include <array>
#include <cmath>
#include <map>

#include "arcslip/continuation/linear/eigenvalues.hpp"
#include "arcslip/continuation/problem/linearization.hpp"
#include "arcslip/continuation/problem/second_derivative.hpp"

namespace arcslip::continuation {
namespace {

/// Of a dense problem's Jacobian at a point along real directions, by differences.
class Derivatives {
 public:
  Derivatives(const Problem& problem, const Guess& at)
      : at_(at), linearization_(problem), scale_(at.unknowns.size()) {
    Vector parameter_scale(at.parameters.size());
    problem.scale(at.unknowns, at.parameters, scale_, parameter_scale);
  }

  bool linear(Matrix& a) {
    if (!jacobian(at_.unknowns, here_)) return false;
    a = here_.reshaped(at_.unknowns.size(), at_.unknowns.size());
    return true;
  }

  /// B(v, .) and C(v, v, .), n x n, after `linear`.
  bool along(const Vector& v, Matrix& first, Matrix& second) {
    constexpr int most = 5;  // of second derivatives finer differences are rounding
    std::map<double, Vector> known;
    const auto once = [&](double h, Vector& out) {
      const auto [place, is_new] = known.try_emplace(h);
      if (is_new && !jacobian(at_.unknowns + h * v, place->second)) place->second.resize(0);
      out = place->second;
      return out.size() > 0;
    };
    // odd in h; its derivative at 0 is the second one of `once`
    const auto twice = [&](double h, Vector& out) {
      Vector behind;
      if (!once(h, out) || !once(-h, behind)) return false;
      out = (out + behind - 2 * here_) / h;
      return true;
    };
    Vector of_first;
    Vector of_second;
    const double begin = step(v);
    if (!std::isfinite(differentiate(once, begin, of_first).error) ||
        !std::isfinite(differentiate(twice, begin, of_second, 0, most).error))
      return false;
    first = of_first.reshaped(v.size(), v.size());
    second = of_second.reshaped(v.size(), v.size());
    return true;
  }

 private:
  bool jacobian(const Vector& u, Vector& out) {
    if (!linearization_.evaluate(u, at_.parameters, at_.regime)) return false;
    out = linearization_.jacobian().reshaped();
    return out.allFinite();
  }

  double step(const Vector& v) const {
    constexpr double first = 0.02;  // of the scale
    const double length = v.cwiseQuotient(scale_).lpNorm<Eigen::Infinity>();
    return length > 0 ? first / length : first;
  }

  const Guess& at_;
  Linearization linearization_;
  Vector scale_;
  Vector here_;
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
  const std::array<Vector, 4> directions{real, imaginary, real + imaginary, real - imaginary};
  std::array<Matrix, 4> second;
  std::array<Vector, 4> cubes;  // C(v, v, v)
  for (std::size_t i = 0; i < 4; ++i) {
    Matrix third;
    if (!derivatives.along(directions[i], second[i], third)) return std::nullopt;
    cubes[i] = third * directions[i];
  }
  const Vector steady = second[0] * real + second[1] * imaginary;  // B(q, q*)
  ComplexVector turning(q.size());                                 // B(q, q)
  turning.real() = second[0] * real - second[1] * imaginary;
  turning.imag() = second[0] * imaginary + second[1] * real;
  const Vector mean = a.partialPivLu().solve(steady);
  ComplexMatrix twice = -a.cast<Complex>();
  twice.diagonal().array() += Complex(0, 2 * omega);
  const ComplexVector higher = twice.partialPivLu().solve(turning);

  const Vector mixed = (cubes[2] + cubes[3] - 2 * cubes[0]) / 6;  // C(Re, Im, Im)
  const Vector other = (cubes[2] - cubes[3] - 2 * cubes[1]) / 6;  // C(Re, Re, Im)
  ComplexVector cube(q.size());                                   // C(q, q, q*)
  cube.real() = cubes[0] + mixed;
  cube.imag() = cubes[1] + other;
  ComplexMatrix turn(q.size(), q.size());  // B(q, .)
  turn.real() = second[0];
  turn.imag() = second[1];
  const Complex cubic = p.dot(cube);
  const Complex by_mean = p.dot(turn * mean.cast<Complex>());
  const Complex by_second = p.dot(turn.conjugate() * higher);
  const double terms = std::abs(cubic) + 2 * std::abs(by_mean) + std::abs(by_second);
  return HopfForm{omega, 0.5 * (cubic - 2.0 * by_mean + by_second).real() / omega, 0.5 * terms / omega};
}

}  // namespace arcslip::continuation
