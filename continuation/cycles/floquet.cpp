#include "arcslip/continuation/cycles/floquet.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>

#include "arcslip/continuation/linear/eigenvalues.hpp"

namespace arcslip::continuation {
namespace {

constexpr double plain = 1e4;  // ratio of stretches of which a product loses no digits that matter

/// The largest stretch over the smallest, about.
double spread(const Matrix& matrix) {
  const Eigen::ColPivHouseholderQR<Matrix> qr(matrix);
  const auto diagonal = qr.matrixQR().diagonal().cwiseAbs();
  const double least = diagonal.minCoeff();
  return least > 0 ? diagonal.maxCoeff() / least : std::numeric_limits<double>::infinity();
}

/// The same product of fewer factors, where digits allow it.
std::vector<Matrix> gathered(const std::vector<Matrix>& factors) {
  std::vector<Matrix> result;
  for (const Matrix& factor : factors) {
    const bool begins = result.empty();
    Matrix product = begins ? factor : Matrix(factor * result.back());
    if (!begins && spread(product) < plain) {
      result.back() = std::move(product);
    } else {
      result.push_back(factor);
    }
  }
  return result;
}

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

}  // namespace

ComplexVector log_multipliers(const std::vector<Matrix>& factors) {
  if (!std::all_of(factors.begin(), factors.end(), [](const Matrix& x) { return x.allFinite(); })) return {};
  const std::vector<Matrix> few = gathered(factors);
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
    Index first = 0;
    for (const Index end : ends(last.turn)) {
      const Index size = end - first;
      Matrix product = Matrix::Identity(size, size);
      double log = 0;
      for (const Matrix& triangle : last.triangles) {
        product = triangle.block(first, first, size, size) * product;
        const double length = product.norm();
        if (!(length > 0)) break;
        product /= length;
        log += std::log(length);
      }
      append_logs(last.turn.block(first, first, size, size) * product, log, logs);
      first = end;
    }
  }
  return Eigen::Map<const ComplexVector>(logs.data(), std::ssize(logs));
}

ComplexVector log_multipliers_beside(const std::vector<Matrix>& factors, const std::vector<Vector>& along) {
  const Index n = factors.front().rows();
  if (n == 1) return ComplexVector(0);
  const auto beside = [n](const Vector& direction) -> Matrix {
    const Matrix column = direction;
    const Matrix all = Eigen::HouseholderQR<Matrix>(column).householderQ();
    return all.rightCols(n - 1);
  };
  std::vector<Matrix> reduced;
  const Matrix first = beside(along.front());
  Matrix before = first;
  for (std::size_t j = 0; j < factors.size(); ++j) {
    const Matrix after = j + 1 < factors.size() ? beside(along[j + 1]) : first;
    reduced.emplace_back(after.transpose() * factors[j] * before);
    before = after;
  }
  return log_multipliers(reduced);
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
