#include "arcslip/continuation/cycles/floquet.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

#include "arcslip/continuation/linear/eigenvalues.hpp"

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

/// Triangular factors of one sweep, and how the basis behind it is made of that before: block by block.
struct Sweep {
  std::vector<Matrix> triangles;
  Matrix turn;
};

Sweep sweep(const std::vector<Matrix>& factors, Matrix& basis) {
  Sweep result;
  const Matrix before = basis;
  for (const Matrix& factor : factors) {
    const Eigen::HouseholderQR<Matrix> qr(factor * basis);
    basis = qr.householderQ();
    result.triangles.emplace_back(qr.matrixQR().triangularView<Eigen::Upper>());
  }
  result.turn = before.transpose() * basis;
  return result;
}

/// Where the invariant subspaces that have parted end.
std::vector<Index> ends(const Matrix& turn) {
  constexpr double rounding = 1e-13;
  const Index n = turn.rows();
  std::vector<Index> result;
  for (Index k = 1; k < n; ++k) {
    if (turn.bottomLeftCorner(n - k, k).cwiseAbs().maxCoeff() < rounding) result.push_back(k);
  }
  result.push_back(n);
  return result;
}

/// ln(mu) of the product of gathered factors.
ComplexVector logs_of(const std::vector<Matrix>& few) {
  if (!std::all_of(few.begin(), few.end(), [](const Matrix& x) { return x.allFinite(); })) return {};
  const Index n = few.front().rows();
  std::vector<Complex> logs;
  if (few.size() == 1) {
    append_logs(few.front(), 0, logs);
  } else {
    constexpr int sweeps = 60;  // what has not parted by then differs by less than twice
    Matrix basis = Matrix::Identity(n, n);
    Sweep last;
    for (int i = 0; i < sweeps; ++i) {
      last = sweep(few, basis);
      if (std::ssize(ends(last.turn)) == n) break;
    }
    Index begin = 0;
    for (const Index end : ends(last.turn)) {
      const Index size = end - begin;
      Matrix product = Matrix::Identity(size, size);
      double log = 0;
      for (const Matrix& triangle : last.triangles) {
        product = triangle.block(begin, begin, size, size) * product;
        const double length = product.norm();
        if (!(length > 0)) break;
        product /= length;
        log += std::log(length);
      }
      append_logs(last.turn.block(begin, begin, size, size) * product, log, logs);
      begin = end;
    }
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

namespace {

/// prod (1 + sign mu), each factor over 1 + |mu|.
double product_of(const ComplexVector& logs, double sign) {
  Complex product = 1;
  for (const Complex& log : logs) {
    const double other = std::exp(-std::abs(log.real()));  // the smaller of 1 and |mu|, over the larger
    const Complex turn = sign * std::polar(1.0, log.imag());
    product *= (log.real() > 0 ? turn + other : 1.0 + turn * other) / (1 + other);
  }
  return product.real();
}

}  // namespace

double doubling_test(const ComplexVector& log_multipliers) { return product_of(log_multipliers, 1); }

double fold_test(const ComplexVector& log_multipliers) {
  return log_multipliers.size() == 0 ? std::nan("") : product_of(log_multipliers, -1);
}

}  // namespace arcslip::continuation
