#include "arcslip/continuation/points/hopf_form.hpp"

#include <Eigen/LU>
#include <Eigen/SparseLU>
#include <array>
#include <cmath>
#include <map>

#include "arcslip/continuation/linear/eigenvalues.hpp"
#include "arcslip/continuation/linear/nearest_eigenvalues.hpp"
#include "arcslip/continuation/problem/linearization.hpp"
#include "arcslip/continuation/problem/second_derivative.hpp"

namespace arcslip::continuation {
namespace {

/// A matrix by its numbers: all of a dense one, or the entries of a sparse pattern.
class Operator {
 public:
  explicit Operator(const Linearization& at)
      : size_(at.residual().size()), is_sparse_(at.sparse()), pattern_(at.sparse_jacobian()) {}

  Vector numbers(const Linearization& at) const {
    if (is_sparse_) return at.sparse_jacobian().coeffs();
    return at.jacobian().reshaped();
  }

  template <class Given>
  Given apply(const Vector& numbers, const Given& x) const {
    if (is_sparse_) return sparse(numbers) * x;
    return numbers.reshaped(size_, size_) * x;
  }

  /// The solution of (matrix - z) x = right.
  ComplexVector solve(const Vector& numbers, Complex z, const ComplexVector& right) const {
    if (is_sparse_) {
      Eigen::SparseMatrix<Complex> identity(size_, size_);
      identity.setIdentity();
      const Eigen::SparseMatrix<Complex> shifted = sparse(numbers).cast<Complex>() - z * identity;
      const Eigen::SparseLU<Eigen::SparseMatrix<Complex>> factors(shifted);
      if (factors.info() != Eigen::Success) return ComplexVector::Constant(size_, std::nan(""));
      return factors.solve(right);
    }
    ComplexMatrix shifted = numbers.reshaped(size_, size_).cast<Complex>();
    shifted.diagonal().array() -= z;
    return shifted.partialPivLu().solve(right);
  }

  ComplexVector eigenvalues(const Vector& numbers, bool transposed, ComplexMatrix& vectors) const {
    if (is_sparse_) {
      const auto matrix = sparse(numbers);
      return nearest_eigenvalues(transposed ? SparseMatrix(matrix.transpose()) : SparseMatrix(matrix),
                                 eigenvalues_looked_at, &vectors);
    }
    const auto matrix = numbers.reshaped(size_, size_);
    return continuation::eigenvalues(transposed ? Matrix(matrix.transpose()) : Matrix(matrix), &vectors);
  }

 private:
  Eigen::Map<const SparseMatrix> sparse(const Vector& numbers) const {
    return {size_,         size_, pattern_.nonZeros(), pattern_.outerIndexPtr(), pattern_.innerIndexPtr(),
            numbers.data()};
  }

  Index size_;
  bool is_sparse_;
  SparseMatrix pattern_;
};

/// Of a problem's Jacobian at a point along real directions, by differences.
class Derivatives {
 public:
  Derivatives(const Problem& problem, const Guess& at)
      : at_(at), linearization_(problem), scale_(at.unknowns.size()) {
    Vector parameter_scale(at.parameters.size());
    problem.scale(at.unknowns, at.parameters, scale_, parameter_scale);
  }

  /// dF/du, and what its numbers are of.
  bool linear(Vector& a, std::optional<Operator>& matrix) {
    if (!linearization_.evaluate(at_.unknowns, at_.parameters, at_.regime)) return false;
    matrix_.emplace(linearization_);
    matrix = matrix_;
    here_ = a = matrix_->numbers(linearization_);
    return a.allFinite();
  }

  /// B(v, .) and C(v, v, .), by their numbers, after `linear`.
  bool along(const Vector& v, Vector& first, Vector& second) {
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
    const double begin = step(v);
    return std::isfinite(differentiate(once, begin, first).error) &&
           std::isfinite(differentiate(twice, begin, second, 0, most).error);
  }

 private:
  bool jacobian(const Vector& u, Vector& out) {
    if (!linearization_.evaluate(u, at_.parameters, at_.regime)) return false;
    out = matrix_->numbers(linearization_);
    return out.allFinite();
  }

  double step(const Vector& v) const {
    constexpr double first = 0.02;  // of the scale
    const double length = v.cwiseQuotient(scale_).lpNorm<Eigen::Infinity>();
    return length > 0 ? first / length : first;
  }

  const Guess& at_;
  Linearization linearization_;
  std::optional<Operator> matrix_;
  Vector scale_;
  Vector here_;
};

/// The vector of the eigenvalue nearest to j omega, of length 1, or of the transposed matrix and -j omega;
/// omega becomes its size.
ComplexVector vector_at(const Operator& matrix, const Vector& a, double sign, double& omega) {
  ComplexMatrix vectors;
  const ComplexVector values = matrix.eigenvalues(a, sign < 0, vectors);
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
  Derivatives derivatives(problem, hopf);
  Vector a;
  std::optional<Operator> matrix;
  if (!derivatives.linear(a, matrix)) return std::nullopt;
  const ComplexVector q = vector_at(*matrix, a, 1, omega);
  double same = omega;
  ComplexVector p = vector_at(*matrix, a, -1, same);
  if (q.size() == 0 || p.size() == 0) return std::nullopt;
  p /= std::conj(p.dot(q));  // p^H q = 1

  const Vector real = q.real();
  const Vector imaginary = q.imag();
  const std::array<Vector, 4> directions{real, imaginary, real + imaginary, real - imaginary};
  std::array<Vector, 4> second;
  std::array<Vector, 4> cubes;  // C(v, v, v)
  for (std::size_t i = 0; i < 4; ++i) {
    Vector third;
    if (!derivatives.along(directions[i], second[i], third)) return std::nullopt;
    cubes[i] = matrix->apply(third, directions[i]);
  }
  const Vector steady = matrix->apply(second[0], real) + matrix->apply(second[1], imaginary);  // B(q, q*)
  ComplexVector turning(q.size());                                                             // B(q, q)
  turning.real() = matrix->apply(second[0], real) - matrix->apply(second[1], imaginary);
  turning.imag() = matrix->apply(second[0], imaginary) + matrix->apply(second[1], real);
  const Vector mean = matrix->solve(a, 0, steady).real();
  const ComplexVector higher = -matrix->solve(a, Complex(0, 2 * omega), turning);

  const Vector mixed = (cubes[2] + cubes[3] - 2 * cubes[0]) / 6;  // C(Re, Im, Im)
  const Vector other = (cubes[2] - cubes[3] - 2 * cubes[1]) / 6;  // C(Re, Re, Im)
  ComplexVector cube(q.size());                                   // C(q, q, q*)
  cube.real() = cubes[0] + mixed;
  cube.imag() = cubes[1] + other;
  const Complex j(0, 1);
  const auto along = [&](double sign, const ComplexVector& x) -> ComplexVector {  // B(q, x), or B(q*, x)
    const Vector by_real = x.real();
    const Vector by_imaginary = x.imag();
    return matrix->apply(second[0], by_real) + j * matrix->apply(second[0], by_imaginary) +
           sign * j * (matrix->apply(second[1], by_real) + j * matrix->apply(second[1], by_imaginary));
  };
  const Complex cubic = p.dot(cube);
  const Complex by_mean = p.dot(along(1, mean.cast<Complex>()));
  const Complex by_second = p.dot(along(-1, higher));
  const double terms = std::abs(cubic) + 2 * std::abs(by_mean) + std::abs(by_second);
  return HopfForm{omega, 0.5 * (cubic - 2.0 * by_mean + by_second).real() / omega, 0.5 * terms / omega};
}

}  // namespace arcslip::continuation
