#include "arcslip/continuation/points/hopf_form.hpp"

#include <array>
#include <cmath>
#include <map>

#include "arcslip/continuation/linear/complex_sparse_factors.hpp"
#include "arcslip/continuation/linear/nearest_eigenvalues.hpp"
#include "arcslip/continuation/problem/linearization.hpp"
#include "arcslip/continuation/problem/second_derivative.hpp"
#include "arcslip/dense.hpp"

namespace arcslip::continuation {
namespace {

struct Spectrum {
  ComplexVector values;
  ComplexMatrix vectors;
};

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
      ComplexSparse identity(size_, size_);
      identity.setIdentity();
      return ComplexSparseFactors(sparse(numbers).cast<Complex>() - z * identity).solve(right);
    }
    ComplexMatrix shifted = numbers.reshaped(size_, size_).cast<Complex>();
    shifted.diagonal().array() -= z;
    return solution_of(shifted, right);
  }

  Spectrum spectrum(const Vector& numbers, bool transposed) const {
    Spectrum found;
    if (is_sparse_) {
      const auto matrix = sparse(numbers);
      found.values = nearest_eigenvalues(transposed ? SparseMatrix(matrix.transpose()) : SparseMatrix(matrix),
                                         eigenvalues_looked_at, &found.vectors);
    } else {
      const auto matrix = numbers.reshaped(size_, size_);
      found.values =
          arcslip::eigenvalues(transposed ? Matrix(matrix.transpose()) : Matrix(matrix), &found.vectors);
    }
    return found;
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

/// Of F along one real direction v: C(v, v, v) and, where the problem gives no series, the numbers of B(v,
/// .).
struct Along {
  Vector v;
  Vector cube;
  Vector second;
};

/// Of F at a point: exact by the problem's series, else by differences of its Jacobian.
class Derivatives {
 public:
  Derivatives(const Problem& problem, const Guess& at)
      : problem_(problem), at_(at), linearization_(problem), scale_(at.unknowns.size()) {
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

  /// After `linear`.
  bool along(const Vector& v, Along& out) {
    out.v = v;
    Matrix terms;
    if (!series(v, 3, terms)) return differences(v, out);
    out.cube = 6 * terms.col(3);
    return terms.allFinite();
  }

  /// B(v, x), by B(v + y, v + y) and B(v - y, v - y) with y as long as v.
  Vector second(const Along& of, const Vector& x) const {
    if (of.second.size() > 0) return matrix_->apply(of.second, x);
    const double longer = of.v.norm() / x.norm();
    if (!std::isfinite(longer) || longer == 0) return Vector::Zero(x.size());
    Matrix sum;
    Matrix difference;
    if (!series(of.v + longer * x, 2, sum) || !series(of.v - longer * x, 2, difference))
      return Vector::Constant(x.size(), std::nan(""));
    return (sum.col(2) - difference.col(2)) / (2 * longer);
  }

 private:
  bool series(const Vector& v, Index order, Matrix& terms) const {
    Matrix u = Matrix::Zero(v.size(), order + 1);
    u.col(0) = at_.unknowns;
    u.col(1) = v;
    return problem_.series(u, at_.parameters, at_.regime, terms);
  }

  bool differences(const Vector& v, Along& out) {
    constexpr int coarse = 5;                    // steps that come before those whose differences may be
    constexpr double more_than_rounding = 1e-9;  // rounding: of the Jacobian, if they are not
    const double begin = step(v);
    const double finest = begin * std::pow(0.25, coarse);
    std::map<double, Vector> known;
    const auto once = [&](double h, Vector& value) {
      const auto [place, is_new] = known.try_emplace(h);
      if (is_new && !jacobian(at_.unknowns + h * v, place->second)) place->second.resize(0);
      value = place->second;
      return value.size() > 0;
    };
    // odd in h; its derivative at 0 is the second one of `once`
    const auto twice = [&](double h, Vector& value) {
      Vector behind;
      if (!once(h, value) || !once(-h, behind)) return false;
      value = (value + behind - 2 * here_) / h;
      return std::abs(h) > finest || std::abs(h) * value.norm() > more_than_rounding * here_.norm();
    };
    Vector third;  // the numbers of C(v, v, .)
    if (!std::isfinite(differentiate(once, begin, out.second).error) ||
        !std::isfinite(differentiate(twice, begin, third).error))
      return false;
    out.cube = matrix_->apply(third, v);
    return true;
  }

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

  const Problem& problem_;
  const Guess& at_;
  Linearization linearization_;
  std::optional<Operator> matrix_;
  Vector scale_;
  Vector here_;
};

/// Where eigenvalues are one and the same: as well as points are located.
constexpr double one_value = 1e-7;  // of the largest

/// The vector of the eigenvalue nearest to j omega, of length 1, or for a `sign` of -1 to -j omega; omega
/// becomes its size. `equal` counts those that are equal to it.
ComplexVector vector_at(const Spectrum& spectrum, double sign, double& omega, int& equal) {
  const ComplexVector& values = spectrum.values;
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
  const double near = one_value * values.cwiseAbs().maxCoeff();
  equal = static_cast<int>(((values.array() - values(best)).abs() <= near).count());
  return spectrum.vectors.col(best).normalized();
}

/// Whether x has a part along y, which symmetry may forbid.
bool has_part(const ComplexVector& x, const ComplexVector& y) {
  constexpr double rounding = 1e-6;  // where branches cross states are known to 1e-8
  return std::abs(x.dot(y)) > rounding * x.norm() * y.norm();
}

/// Of a vector and A^{-1} times that, if an odd number of real eigenvalues above 0 enters the latter: those
/// whose vectors count.
template <class Counts>
bool passes_poles(const Spectrum& right, const Spectrum& left, const ComplexVector& vector,
                  const ComplexVector& solution, const Counts& counts) {
  bool is_odd = false;
  const double least = right.values.cwiseAbs().minCoeff();
  for (Index i = 0; i < right.values.size(); ++i) {
    if (right.values(i).imag() != 0) continue;
    Index same = 0;
    (left.values.array() - right.values(i)).abs().minCoeff(&same);
    const ComplexVector w = left.vectors.col(same);
    const ComplexVector v = right.vectors.col(i);
    // the sign of one that is rounding is as was solved
    const double above = std::abs(right.values(i)) > least
                             ? right.values(i).real()
                             : (std::conj(w.dot(vector)) * w.dot(solution)).real();
    if (above > 0 && has_part(w, v) && has_part(w, vector) && counts(v)) is_odd = !is_odd;
  }
  return is_odd;
}

}  // namespace

std::optional<HopfForm> hopf_form(const Problem& problem, const Guess& hopf, double omega) {
  Derivatives derivatives(problem, hopf);
  Vector a;
  std::optional<Operator> matrix;
  if (!derivatives.linear(a, matrix)) return std::nullopt;
  int pairs = 1;
  const Spectrum right = matrix->spectrum(a, false);
  const ComplexVector q = vector_at(right, 1, omega, pairs);
  if (pairs > 1) return HopfForm{omega, std::nan(""), 0, pairs};
  double same = omega;
  const Spectrum left = matrix->spectrum(a, true);
  ComplexVector p = vector_at(left, -1, same, pairs);
  if (q.size() == 0 || p.size() == 0) return std::nullopt;
  const double apart = std::abs(p.dot(q)) / p.cwiseAbs().dot(q.cwiseAbs());
  p /= std::conj(p.dot(q));  // p^H q = 1

  const Vector real = q.real();
  const Vector imaginary = q.imag();
  const std::array<Vector, 4> directions{real, imaginary, real + imaginary, real - imaginary};
  std::array<Along, 4> along;
  for (std::size_t i = 0; i < 4; ++i) {
    if (!derivatives.along(directions[i], along[i])) return std::nullopt;
  }
  const auto by_real = [&](const Vector& x) { return derivatives.second(along[0], x); };
  const auto by_imaginary = [&](const Vector& x) { return derivatives.second(along[1], x); };
  const Complex j(0, 1);
  const auto second = [&](double sign, const ComplexVector& x) -> ComplexVector {  // B(q, x), or B(q*, x)
    return by_real(x.real()) + j * by_real(x.imag()) +
           sign * j * (by_imaginary(x.real()) + j * by_imaginary(x.imag()));
  };
  const ComplexVector pushed = second(-1, q).real().cast<Complex>();  // B(q, q*)
  const ComplexVector mean = matrix->solve(a, 0, pushed);
  constexpr double rounding = 1e-12;  // of a solution, however large
  const double left_over = (matrix->apply(a, mean) - pushed).norm();
  if (!(left_over <= rounding * (a.norm() * mean.norm() + pushed.norm())))
    return HopfForm{omega, std::nan(""), 0, pairs, apart};
  const ComplexVector higher = -matrix->solve(a, Complex(0, 2 * omega), second(1, q));

  const Vector mixed = (along[2].cube + along[3].cube - 2 * along[0].cube) / 6;  // C(Re, Im, Im)
  const Vector other = (along[2].cube - along[3].cube - 2 * along[1].cube) / 6;  // C(Re, Re, Im)
  ComplexVector cube(q.size());                                                  // C(q, q, q*)
  cube.real() = along[0].cube + mixed;
  cube.imag() = along[1].cube + other;
  const Complex cubic = p.dot(cube);
  const Complex by_mean = p.dot(second(1, mean));
  const Complex by_second = p.dot(second(-1, higher));
  const double terms = std::abs(cubic) + 2 * std::abs(by_mean) + std::abs(by_second);
  return HopfForm{omega,
                  0.5 * (cubic - 2.0 * by_mean + by_second).real() / omega,
                  0.5 * terms / omega,
                  pairs,
                  apart,
                  passes_poles(right, left, pushed, mean,
                               [&](const ComplexVector& v) { return has_part(p, second(1, v)); })};
}

}  // namespace arcslip::continuation
