#include "ritz_space.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <cmath>
#include <numbers>

namespace arcslip {

/// Fills the last row and column of V^H A V.
void RitzSpace::widen(NumberMatrix& projection, Index column, const NumberVector& product) {
  projection.conservativeResize(column + 1, column + 1);
  for (Index i = 0; i <= column; ++i) {
    Number sum = 0;
    for (Index dof = 0; dof < product.size(); ++dof) sum += std::conj(Number(basis_(dof, i))) * product(dof);
    projection(i, column) = sum;
    projection(column, i) = std::conj(sum);
  }
  projection(column, column) = projection(column, column).real();
}

void RitzSpace::add(const ComplexMatrix& columns) {
  const Index first = basis_.cols();
  basis_.conservativeResize(Eigen::NoChange, first + columns.cols());
  basis_.rightCols(columns.cols()) = columns;
  load_.conservativeResize(basis_.cols());
  for (Index column = first; column < basis_.cols(); ++column) {
    const NumberVector vector = basis_.col(column).cast<Number>();
    const NumberVector unfolded = sector_.unfold(vector);
    widen(mass_, column, sector_.mass_times(unfolded));
    widen(stiffness_, column, sector_.stiffness_times(unfolded));
    load_(column) = vector.dot(sector_.load());
  }
}

SectorModes RitzSpace::modes(double below) const {
  const Real shift = below;
  // Of this pencil the lowest modes are the largest and keep all their digits.
  const NumberMatrix shifted = stiffness_ - Number(shift) * mass_;
  if (mass_.llt().info() != Eigen::Success)
    throw SectorError("the mass matrix is not positive definite under this wave");
  if (shifted.llt().info() != Eigen::Success)
    throw SectorError("the stiffness matrix is not positive semidefinite under this wave");
  const Eigen::GeneralizedSelfAdjointEigenSolver<NumberMatrix> solver(mass_, shifted);
  if (solver.info() != Eigen::Success) throw SectorError("the modes of the sector were not found");
  NumberMatrix observed(sector_.contacts() + sector_.outputs(), size());  // what is seen of each vector
  for (Index i = 0; i < size(); ++i) observed.col(i) = sector_.observed(basis_.col(i).cast<Number>());
  const Real two_pi = 2 * std::numbers::pi_v<Real>;
  SectorModes found;
  found.shapes.resize(observed.rows(), size());
  found.loads.resize(size());
  for (Index k = 0; k < size(); ++k) {
    const Index place = size() - 1 - k;
    const Real theta = solver.eigenvalues()(place);  // 1/(lambda - shift)
    const NumberVector shape = solver.eigenvectors().col(place) / (std::sqrt(theta) * two_pi);
    const Real square = std::max(shift + 1 / theta, Real(0));
    found.frequencies.push_back(static_cast<double>(std::sqrt(square) / two_pi));
    found.shapes.col(k) = (observed * shape).cast<Complex>();
    found.loads(k) = Complex(shape.dot(load_));
  }
  return found;
}

}  // namespace arcslip
