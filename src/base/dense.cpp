#include "arcslip/dense.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/QR>
#include <Eigen/SVD>
#include <unsupported/Eigen/MatrixFunctions>

namespace arcslip {
namespace {

template <class Dense>
Dense kernel_by(const Dense& matrix, std::optional<double> rank) {
  if (matrix.rows() == 0) return Dense::Identity(matrix.cols(), matrix.cols());
  if (matrix.cols() == 0) return Dense(0, 0);
  Eigen::FullPivLU<Dense> factors(matrix);
  if (rank) factors.setThreshold(*rank);
  if (factors.dimensionOfKernel() == 0) return Dense(matrix.cols(), 0);
  return factors.kernel();
}

template <class Dense>
SingularAxes<Dense> axes_by(const Dense& matrix) {
  const Eigen::JacobiSVD<Dense> parts(matrix, Eigen::ComputeThinU | Eigen::ComputeThinV);
  return {parts.matrixU(), parts.singularValues(), parts.matrixV()};
}

template <class Dense>
std::optional<Pencil<Dense>> found_by(const Eigen::SelfAdjointEigenSolver<Dense>& solver) {
  if (solver.info() != Eigen::Success) return {};
  return Pencil<Dense>{solver.eigenvalues(), solver.eigenvectors()};
}

}  // namespace

Vector solution_of(const Matrix& a, const Vector& b) { return a.partialPivLu().solve(b); }

Matrix solution_of(const Matrix& a, const Matrix& b) { return a.partialPivLu().solve(b); }

ComplexVector solution_of(const ComplexMatrix& a, const ComplexVector& b) {
  return a.partialPivLu().solve(b);
}

ComplexMatrix solution_of(const ComplexMatrix& a, const ComplexMatrix& b) {
  return a.partialPivLu().solve(b);
}

Eigen::Vector2d solution_of(const Eigen::Matrix2d& a, const Eigen::Vector2d& b) {
  return a.partialPivLu().solve(b);
}

std::function<ComplexMatrix(const ComplexMatrix& b)> solver_of(const ComplexMatrix& a) {
  return [factors = Eigen::PartialPivLU<ComplexMatrix>(a)](const ComplexMatrix& b) {
    return ComplexMatrix(factors.solve(b));
  };
}

std::optional<Matrix> inverse_of(const Matrix& matrix) {
  const Eigen::FullPivLU<Matrix> factors(matrix);
  if (!factors.isInvertible()) return std::nullopt;
  return factors.inverse();
}

double determinant_of(const Matrix& matrix) { return matrix.determinant(); }

ComplexVector eigenvalues(const Matrix& matrix, ComplexMatrix* vectors) {
  const Eigen::EigenSolver<Matrix> solver(matrix, vectors != nullptr);
  if (vectors != nullptr) *vectors = solver.eigenvectors();
  return solver.eigenvalues();
}

Pivots pivots_of(const Matrix& matrix) {
  const Eigen::PartialPivLU<Matrix> factors(matrix);
  const Vector pivots = factors.matrixLU().diagonal();
  const auto negative = (pivots.array() < 0).count();
  return {pivots.cwiseAbs(),
          static_cast<int>(factors.permutationP().determinant()) * (negative % 2 == 0 ? 1 : -1)};
}

int orientation(const Matrix& matrix) { return pivots_of(matrix).sign; }

double reciprocal_condition(const Matrix& matrix) { return Eigen::PartialPivLU<Matrix>(matrix).rcond(); }

Vector shortest(const Matrix& a, const Vector& b) { return a.completeOrthogonalDecomposition().solve(b); }

Matrix shortest(const Matrix& a, const Matrix& b) { return a.completeOrthogonalDecomposition().solve(b); }

ComplexVector shortest(const ComplexMatrix& a, const ComplexVector& b) {
  return a.completeOrthogonalDecomposition().solve(b);
}

ComplexMatrix shortest(const ComplexMatrix& a, const ComplexMatrix& b) {
  return a.completeOrthogonalDecomposition().solve(b);
}

Matrix pseudo_inverse(const Matrix& matrix) {
  return matrix.completeOrthogonalDecomposition().pseudoInverse();
}

ComplexMatrix pseudo_inverse(const ComplexMatrix& matrix) {
  return matrix.completeOrthogonalDecomposition().pseudoInverse();
}

std::function<Vector(const Vector& b)> least_squares_of(const Matrix& a, std::optional<double> rank) {
  if (!rank) {
    return [factors = Eigen::HouseholderQR<Matrix>(a)](const Vector& b) { return Vector(factors.solve(b)); };
  }
  Eigen::CompleteOrthogonalDecomposition<Matrix> factors;
  factors.setThreshold(*rank);
  factors.compute(a);
  return [factors = std::move(factors)](const Vector& b) { return Vector(factors.solve(b)); };
}

Matrix orthonormal(const Matrix& columns) {
  return Eigen::HouseholderQR<Matrix>(columns).householderQ() *
         Matrix::Identity(columns.rows(), columns.cols());
}

void orthogonalise(const Matrix& columns, Matrix& q, Matrix& r) {
  const Eigen::HouseholderQR<Matrix> factors(columns);
  q.setIdentity(columns.rows(), columns.cols());
  q.applyOnTheLeft(factors.householderQ());
  r = factors.matrixQR().topRows(columns.cols()).triangularView<Eigen::Upper>();
}

Matrix perpendicular(const Matrix& columns, double rank) {
  const Eigen::ColPivHouseholderQR<Matrix> factors(columns);
  const Index count = columns.cols();
  if (std::abs(factors.matrixQR()(count - 1, count - 1)) < rank) return Matrix(columns.rows(), 0);
  Matrix others = Matrix::Zero(columns.rows(), columns.rows() - count);
  others.bottomRows(others.cols()).setIdentity();
  others.applyOnTheLeft(factors.householderQ());
  return others;
}

Matrix kernel_of(const Matrix& matrix, std::optional<double> rank) { return kernel_by(matrix, rank); }

ComplexMatrix kernel_of(const ComplexMatrix& matrix, std::optional<double> rank) {
  return kernel_by(matrix, rank);
}

ComplexMatrix fewest_rows(const ComplexMatrix& matrix) {
  const Eigen::ColPivHouseholderQR<ComplexMatrix> parts(matrix);
  const ComplexMatrix upper = parts.matrixR().topRows(parts.rank()).triangularView<Eigen::Upper>();
  return upper * parts.colsPermutation().transpose();
}

double least_pivot(const ComplexMatrix& matrix) {
  const Eigen::ColPivHouseholderQR<ComplexMatrix> factors(matrix);
  return factors.matrixR().diagonal().cwiseAbs().minCoeff();
}

SingularAxes<Matrix> singular_axes(const Matrix& matrix) { return axes_by(matrix); }

SingularAxes<ComplexMatrix> singular_axes(const ComplexMatrix& matrix) { return axes_by(matrix); }

Vector least_moved(const Matrix& matrix) { return singular_axes(matrix).from.rightCols(1); }

bool is_definite(const Matrix& matrix, double rounding) {
  const Eigen::LLT<Matrix> factors(matrix);
  return factors.info() == Eigen::Success && factors.rcond() >= rounding;
}

bool is_definite(const ComplexMatrix& matrix) { return matrix.llt().info() == Eigen::Success; }

std::optional<Pencil<Matrix>> pencil(const Matrix& a, const Matrix& b) {
  return found_by<Matrix>(Eigen::GeneralizedSelfAdjointEigenSolver<Matrix>(a, b));
}

std::optional<Pencil<Matrix>> pencil(const Matrix& a) {
  return found_by(Eigen::SelfAdjointEigenSolver<Matrix>(a));
}

std::optional<Pencil<ComplexMatrix>> pencil(const ComplexMatrix& a, const ComplexMatrix& b) {
  return found_by<ComplexMatrix>(Eigen::GeneralizedSelfAdjointEigenSolver<ComplexMatrix>(a, b));
}

std::optional<Pencil<ComplexMatrix>> pencil(const ComplexMatrix& a) {
  return found_by(Eigen::SelfAdjointEigenSolver<ComplexMatrix>(a));
}

Matrix exponential(const Matrix& matrix) { return matrix.exp(); }

ComplexMatrix exponential(const ComplexMatrix& matrix) { return matrix.exp(); }

}  // namespace arcslip
