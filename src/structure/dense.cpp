#include "arcslip/structure/dense.hpp"

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
  const Eigen::JacobiSVD<Dense> parts(matrix, Eigen::ComputeThinU);
  return {parts.matrixU(), parts.singularValues()};
}

template <class Dense>
std::optional<Pencil<Dense>> pencil_by(const Dense& a, const Dense& b) {
  const Eigen::GeneralizedSelfAdjointEigenSolver<Dense> found(a, b);
  if (found.info() != Eigen::Success) return {};
  return Pencil<Dense>{found.eigenvalues(), found.eigenvectors()};
}

}  // namespace

Vector solution_of(const Matrix& a, const Vector& b) { return a.partialPivLu().solve(b); }

Matrix solution_of(const Matrix& a, const Matrix& b) { return a.partialPivLu().solve(b); }

ComplexVector solution_of(const ComplexMatrix& a, const ComplexVector& b) {
  return a.partialPivLu().solve(b);
}

int orientation(const Matrix& matrix) {
  const Eigen::PartialPivLU<Matrix> factors(matrix);
  const auto negative = (factors.matrixLU().diagonal().array() < 0).count();
  return factors.permutationP().determinant() * (negative % 2 == 0 ? 1 : -1);
}

Vector shortest(const Matrix& a, const Vector& b) { return a.completeOrthogonalDecomposition().solve(b); }

Matrix shortest(const Matrix& a, const Matrix& b) { return a.completeOrthogonalDecomposition().solve(b); }

ComplexVector shortest(const ComplexMatrix& a, const ComplexVector& b) {
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

Matrix kernel_of(const Matrix& matrix) { return kernel_by(matrix, {}); }

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

Vector least_moved(const Matrix& matrix) {
  return singular_axes(Matrix(matrix.transpose())).directions.rightCols(1);
}

bool is_definite(const Matrix& matrix, double rounding) {
  const Eigen::LLT<Matrix> factors(matrix);
  return factors.info() == Eigen::Success && factors.rcond() >= rounding;
}

bool is_definite(const ComplexMatrix& matrix) { return matrix.llt().info() == Eigen::Success; }

std::optional<Pencil<Matrix>> pencil(const Matrix& a, const Matrix& b) { return pencil_by(a, b); }

std::optional<Pencil<ComplexMatrix>> pencil(const ComplexMatrix& a, const ComplexMatrix& b) {
  return pencil_by(a, b);
}

Matrix exponential(const Matrix& matrix) { return matrix.exp(); }

ComplexMatrix exponential(const ComplexMatrix& matrix) { return matrix.exp(); }

}  // namespace arcslip
