// Multipliers of large orbits, by products with the monodromy matrix.

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "arcslip/continuation/cycles/floquet.hpp"
#include "arcslip/continuation/linear/bordered_solver.hpp"
#include "arcslip/dense.hpp"

namespace arcslip::continuation {
namespace {

/// du at the end by du at the start, interval by interval: R (inner nodes, right end) = -L (left end).
class Monodromy {
 public:
  Monodromy(const SparseMatrix& jacobian, Index n, Index intervals, Index degree, const Matrix& along)
      : n_(n), along_(along), right_(n * degree) {
    along_.colwise().normalize();
    const Index rows = n * degree;
    const Vector ones = Vector::Ones(rows);
    for (Index j = 0; j < intervals; ++j) {
      const SparseMatrix columns = jacobian.middleCols(j * rows, rows + n);
      const Eigen::SparseMatrix<double, Eigen::RowMajor> by_rows = columns;
      const SparseMatrix within = by_rows.middleRows(n + j * rows, rows);
      SparseMatrix inner = within.rightCols(rows);
      inner.makeCompressed();
      left_.emplace_back(within.leftCols(n));
      solvers_.push_back(make_bordered_solver(rows, 0, true));
      solvers_.back()->set_jacobian(inner, ones);
      is_regular_ = is_regular_ && solvers_.back()->factor() != 0;
    }
  }

  bool is_regular() const { return is_regular_; }
  Index rows() const { return n_; }
  Index cols() const { return n_; }

  /// Beside the velocity, which it would take to itself.
  void perform_op(const double* x, double* y) const {
    Vector at = Eigen::Map<const Vector>(x, n_);
    project(at, 0);
    for (std::size_t j = 0; j < solvers_.size(); ++j) {
      right_.noalias() = -(left_[j] * at);
      solvers_[j]->solve(right_);
      at = right_.tail(n_);
      project(at, j + 1 < solvers_.size() ? j + 1 : 0);
    }
    Eigen::Map<Vector>(y, n_) = at;
  }

 private:
  void project(Vector& x, std::size_t border) const {
    const auto column = static_cast<Index>(border);
    if (along_.size() > 0) x -= along_.col(column).dot(x) * along_.col(column);
  }

  Index n_;
  Matrix along_;  // of length 1, at the borders of intervals; or empty
  mutable Vector right_;
  std::vector<SparseMatrix> left_;
  std::vector<std::unique_ptr<BorderedSolver>> solvers_;
  bool is_regular_ = true;
};

/// The eigenvalues that Arnoldi's method knows to rounding, of a matrix that shrinks all but few directions:
/// from one start, without restarts, until nothing is left beside the basis.
std::vector<Complex> known_eigenvalues(const Monodromy& monodromy, Index most) {
  constexpr double nothing = 1e-13;
  constexpr double known = 1e-10;
  const Index n = monodromy.rows();
  Matrix basis(n, most + 1);
  Matrix projected = Matrix::Zero(most + 1, most);
  Vector next(n);
  basis.col(0) = Vector::LinSpaced(n, 1, 2).array().sin() + Vector::LinSpaced(n, 0, 37.0 * pi).array().cos();
  basis.col(0).normalize();
  Index count = 0;
  double rest = 1;
  while (count < most && rest > nothing * projected.norm()) {
    monodromy.perform_op(basis.col(count).data(), next.data());
    for (int twice = 0; twice < 2; ++twice) {
      const Vector parts = basis.leftCols(count + 1).transpose() * next;
      projected.col(count).head(count + 1) += parts;
      next.noalias() -= basis.leftCols(count + 1) * parts;
    }
    rest = next.norm();
    projected(count + 1, count) = rest;
    ++count;
    if (rest > 0) basis.col(count) = next / rest;
  }
  ComplexMatrix vectors;
  const ComplexVector values = eigenvalues(projected.topLeftCorner(count, count), &vectors);
  std::vector<Complex> result;
  for (Index i = 0; i < values.size(); ++i) {
    const double residual = rest * std::abs(vectors(count - 1, i)) / vectors.col(i).norm();
    if (residual <= known * std::max(1.0, values.cwiseAbs().maxCoeff())) result.push_back(values(i));
  }
  return result;
}

}  // namespace

ComplexVector largest_log_multipliers(const SparseMatrix& jacobian, Index n, Index intervals, Index degree,
                                      const Matrix& along, Index count) {
  constexpr Index widest = 200;       // basis
  constexpr double rounding = 1e-12;  // of the largest: what Arnoldi's method leaves
  const Monodromy monodromy(jacobian, n, intervals, degree, along);
  if (!monodromy.is_regular()) return {};
  std::vector<Complex> found = known_eigenvalues(monodromy, std::min(n, widest));
  std::sort(found.begin(), found.end(),
            [](const Complex& a, const Complex& b) { return std::abs(a) > std::abs(b); });
  std::vector<Complex> logs;
  for (const Complex& one : found) {
    const bool counts = logs.empty() || std::abs(one) > rounding * std::max(1.0, std::abs(found.front()));
    if (std::ssize(logs) < count && counts) logs.push_back(std::log(one));
  }
  return Eigen::Map<const ComplexVector>(logs.data(), std::ssize(logs));
}

}  // namespace arcslip::continuation
