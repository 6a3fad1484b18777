#include "arcslip/structure/spectrum.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <algorithm>

#include "arcslip/dense.hpp"

namespace arcslip {
namespace {

template <class Dense>
Dense deflate(Dense matrix, const Dense& subspace) {
  const Eigen::HouseholderQR<Dense> turned(subspace);
  matrix.applyOnTheLeft(turned.householderQ().adjoint());
  matrix.applyOnTheRight(turned.householderQ());
  const Index rest = matrix.rows() - subspace.cols();
  return matrix.bottomRightCorner(rest, rest);
}

template <class Dense>
Dense lasting_by(const Dense& map, Dense vector) {
  constexpr int rounds = 4;
  const Index n = map.rows();
  Dense equations(2 * n, n);
  equations << map - Dense::Identity(n, n), Dense::Zero(n, n);
  for (int round = 0; round < rounds; ++round) {
    const Dense change = equations.topRows(n) * vector;
    equations.bottomRows(n).diagonal().setConstant(change.norm() / vector.norm());
    Dense right = Dense::Zero(2 * n, 1);
    right.topRows(n) = change;
    vector -= Dense(equations.householderQr().solve(right));
  }
  return vector;
}

ComplexVector sorted(ComplexVector values) {
  std::sort(values.begin(), values.end(),
            [](const Complex& a, const Complex& b) { return std::abs(a) > std::abs(b); });
  return values;
}

}  // namespace

ComplexVector spectrum(const Matrix& matrix) { return sorted(eigenvalues(matrix)); }

ComplexVector spectrum(const ComplexMatrix& matrix) { return sorted(matrix.eigenvalues()); }

Matrix deflated(const Matrix& matrix, const Matrix& subspace) { return deflate(matrix, subspace); }

ComplexMatrix deflated(const ComplexMatrix& matrix, const ComplexMatrix& subspace) {
  return deflate(matrix, subspace);
}

Matrix lasting_near(const Matrix& map, const Matrix& vector) { return lasting_by(map, vector); }

ComplexMatrix lasting_near(const ComplexMatrix& map, const ComplexMatrix& vector) {
  return lasting_by(map, vector);
}

ComplexVector eigenvector(const ComplexMatrix& matrix, const Complex& value) {
  const Complex beside = value + 1e-10 * std::max(std::abs(value), matrix.norm() * 1e-3);
  const auto solver = solver_of(matrix - beside * ComplexMatrix::Identity(matrix.rows(), matrix.rows()));
  ComplexVector vector(matrix.rows());  // in no invariant subspace
  for (Index i = 0; i < vector.size(); ++i) vector(i) = std::polar(1.0, static_cast<double>(i * i));
  for (int round = 0; round < 3; ++round) vector = ComplexVector(solver(vector)).normalized();
  return vector;
}

}  // namespace arcslip
