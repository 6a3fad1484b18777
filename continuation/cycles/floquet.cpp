#include "arcslip/continuation/cycles/floquet.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

#include "arcslip/continuation/linear/borders.hpp"
#include "arcslip/dense.hpp"

namespace arcslip::continuation {
namespace {

constexpr double plain = 1e4;  // ratio of stretches of which a product loses no digits that matter

/// The largest stretch over the smallest, about: of pivots, each the largest entry that is left.
double spread(const Matrix& matrix, Matrix& work) {
  work = matrix;
  double* const a = work.data();
  const Index n = matrix.rows();
  double most = 0;
  double least = std::numeric_limits<double>::infinity();
  for (Index k = 0; k < n; ++k) {
    Index row = k;
    Index column = k;
    for (Index j = k; j < n; ++j) {
      for (Index i = k; i < n; ++i) {
        if (std::abs(a[j * n + i]) > std::abs(a[column * n + row])) std::tie(row, column) = std::pair(i, j);
      }
    }
    for (Index i = 0; i < n; ++i) std::swap(a[k * n + i], a[column * n + i]);
    for (Index j = 0; j < n; ++j) std::swap(a[j * n + k], a[j * n + row]);
    const double pivot = a[k * n + k];
    most = std::max(most, std::abs(pivot));
    least = std::min(least, std::abs(pivot));
    if (pivot == 0) break;
    for (Index j = k + 1; j < n; ++j) {
      const double factor = a[j * n + k] / pivot;
      for (Index i = k + 1; i < n; ++i) a[j * n + i] -= factor * a[k * n + i];
    }
  }
  return least > 0 ? most / least : std::numeric_limits<double>::infinity();
}

/// A product of fewer factors, where digits allow it.
class Gathered {
 public:
  /// The next factor.
  void add(const Matrix& factor) {
    if (!factors_.empty()) product_.noalias() = factor.lazyProduct(factors_.back());
    if (!factors_.empty() && spread(product_, work_) < plain) {
      factors_.back().swap(product_);
    } else {
      factors_.push_back(factor);
    }
  }
  const std::vector<Matrix>& factors() const { return factors_; }

 private:
  std::vector<Matrix> factors_;
  Matrix product_;
  Matrix work_;
};

/// ln of the eigenvalues of e^log times a matrix.
void append_logs(const Matrix& matrix, double log, std::vector<Complex>& out) {
  const ComplexVector values = eigenvalues(matrix);
  for (const Complex& value : values) {
    const double size = std::abs(value);
    out.emplace_back(size > 0 ? std::log(size) + log : -std::numeric_limits<double>::infinity(),
                     std::arg(value));
  }
}

/// A basis that goes round by the factors, again and again: its first vectors turn to where most is
/// stretched.
class Subspaces {
 public:
  explicit Subspaces(const std::vector<Matrix>& factors)
      : factors_(factors),
        triangles_(factors.size()),
        basis_(Matrix::Identity(factors.front().rows(), factors.front().cols())),
        apart_(basis_.cols(), 1) {}

  void go_round() {
    const Matrix before = basis_;
    for (std::size_t j = 0; j < factors_.size(); ++j) {
      turned_.noalias() = factors_[j] * basis_;
      orthogonalise(turned_, basis_, triangles_[j]);
    }
    turn_ = before.transpose() * basis_;
    find_ends();
  }

  /// What the factors make of an invariant subspace: e^log times a matrix.
  struct Part {
    Matrix matrix;
    double log = 0;
  };

  /// Of the subspaces that have parted.
  std::vector<Part> parts() const {
    std::vector<Part> result;
    Index begin = 0;
    for (const Index end : ends_) {
      const Index size = end - begin;
      Part& part = result.emplace_back(Part{Matrix::Identity(size, size)});
      for (const Matrix& triangle : triangles_) {
        part.matrix = triangle.block(begin, begin, size, size) * part.matrix;
        const double length = part.matrix.norm();
        if (!(length > 0)) break;
        part.matrix /= length;
        part.log += std::log(length);
      }
      part.matrix = turn_.block(begin, begin, size, size) * part.matrix;
      begin = end;
    }
    return result;
  }

 private:
  /// Of subspaces that have parted, to rounding or as far as the factors tell.
  void find_ends() {
    constexpr double rounding = 1e-13;
    constexpr double small = 1e-6;   // what only rounding keeps
    constexpr double shrinks = 0.5;  // in a round, or rounding keeps it
    const Index n = turn_.rows();
    ends_.clear();
    for (Index k = 1; k < n; ++k) {
      const double before = std::exchange(apart_[static_cast<std::size_t>(k)],
                                          turn_.bottomLeftCorner(n - k, k).cwiseAbs().maxCoeff());
      const double now = apart_[static_cast<std::size_t>(k)];
      if (now < rounding || (now < small && before < small && now > shrinks * before)) ends_.push_back(k);
    }
    ends_.push_back(n);
  }

  const std::vector<Matrix>& factors_;
  std::vector<Matrix> triangles_;  // of the last round
  Matrix basis_;
  Matrix turned_;              // by one factor
  Matrix turn_;                // in the last round
  std::vector<double> apart_;  // what the first vectors have left of their subspace
  std::vector<Index> ends_;
};

/// ln(mu) of the product of gathered factors.
ComplexVector logs_of(const std::vector<Matrix>& few) {
  if (!std::all_of(few.begin(), few.end(), [](const Matrix& x) { return x.allFinite(); })) return {};
  std::vector<Complex> logs;
  if (few.size() == 1) {
    append_logs(few.front(), 0, logs);
  } else {
    constexpr int most = 60;  // what has not parted by then differs by less than twice
    Subspaces subspaces(few);
    std::vector<Subspaces::Part> parts;
    Matrix work;
    for (int i = 0; i < most; ++i) {
      subspaces.go_round();
      parts = subspaces.parts();
      const auto loses = [&](const Subspaces::Part& part) {
        return part.matrix.size() > 1 && !(spread(part.matrix, work) < plain);
      };
      if (std::none_of(parts.begin(), parts.end(), loses)) break;
    }
    for (const Subspaces::Part& part : parts) append_logs(part.matrix, part.log, logs);
  }
  return Eigen::Map<const ComplexVector>(logs.data(), std::ssize(logs));
}

}  // namespace

ComplexVector log_multipliers(const std::vector<Matrix>& factors) {
  Gathered few;
  for (const Matrix& factor : factors) few.add(factor);
  return logs_of(few.factors());
}

ComplexVector log_multipliers_beside(const std::vector<Matrix>& factors, const Matrix& along) {
  const Index n = along.rows();
  if (n == 1) return ComplexVector(0);
  Matrix mirrors = along;  // v of 1 - 2 v v^T, which turns a direction into the first axis
  mirrors.rightCols(1) = along.leftCols(1);
  for (auto mirror : mirrors.colwise()) {
    mirror.normalize();
    mirror(0) += std::copysign(1, mirror(0));
    mirror.normalize();
  }
  Gathered reduced;
  Matrix turned(n, n);
  Vector image(n);
  for (std::size_t j = 0; j < factors.size(); ++j) {
    turned = factors[j];
    const auto before = mirrors.col(static_cast<Index>(j));
    const auto after = mirrors.col(static_cast<Index>(j) + 1);
    image = 2 * turned.lazyProduct(before);
    turned -= image.lazyProduct(before.transpose());
    image = 2 * turned.transpose().lazyProduct(after);
    turned -= after.lazyProduct(image.transpose());
    reduced.add(turned.bottomRightCorner(n - 1, n - 1));
  }
  return logs_of(reduced.factors());
}

ComplexVector exponents(const ComplexVector& logs, double duration) {
  ComplexVector values = logs;
  for (Complex& value : values) {
    value.real(std::max(value.real(), -1e3));  // of a multiplier that is 0
    if (std::abs(value.imag()) == pi) value.imag(0);
  }
  return values / duration;
}

void remove_multiplier(ComplexVector& logs, Complex log) {
  const auto from_log = [&](Complex value) {
    value -= log;
    return Complex(value.real(), std::remainder(value.imag(), 2 * pi));
  };
  if (log.imag() == 0 || std::abs(log.imag()) == pi) {
    take_real(logs, from_log, {log.real(), std::abs(log.imag())});
  } else {
    take_nearest(logs, from_log);
  }
}

namespace {

/// 1 + sign mu over 1 + |mu|.
Complex factor_of(const Complex& log, double sign) {
  const double other = std::exp(-std::abs(log.real()));  // the smaller of 1 and |mu|, over the larger
  const Complex turn = sign * std::polar(1.0, log.imag());
  return (log.real() > 0 ? turn + other : 1.0 + turn * other) / (1 + other);
}

double product_of(const ComplexVector& logs, double sign) {
  Complex product = 1;
  for (const Complex& log : logs) product *= factor_of(log, sign);
  return product.real();
}

double products_but_one(const ComplexVector& logs, double sign) {
  if (logs.size() == 0) return std::nan("");
  Complex sum = 0;
  for (Index without = 0; without < logs.size(); ++without) {
    Complex product = 1;
    for (Index i = 0; i < logs.size(); ++i) {
      if (i != without) product *= factor_of(logs(i), sign);
    }
    sum += product;
  }
  return sum.real();
}

}  // namespace

double doubling_test(const ComplexVector& log_multipliers) { return product_of(log_multipliers, 1); }

double fold_test(const ComplexVector& log_multipliers) {
  return log_multipliers.size() == 0 ? std::nan("") : product_of(log_multipliers, -1);
}

double second_doubling_test(const ComplexVector& log_multipliers) {
  return products_but_one(log_multipliers, 1);
}

double second_fold_test(const ComplexVector& log_multipliers) {
  return products_but_one(log_multipliers, -1);
}

}  // namespace arcslip::continuation
