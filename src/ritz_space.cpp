#include "ritz_space.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <cmath>
#include <numbers>

namespace arcslip {

RitzSpace::RitzSpace(const FiniteSector& sector, const SectorWave& wave)
    : sector_(sector), map_(sector_map(sector)), basis_(map_.size, 0) {
  const Real a = 2 * std::numbers::pi_v<Real> * static_cast<Real>(wave.wave_number) /
                 static_cast<Real>(wave.sectors);
  forward_ = {std::cos(a), -std::sin(a)};
  folded_load_ = fold(sector.load.cast<Number>());
}

/// T^H f.
RitzSpace::NumberVector RitzSpace::fold(const NumberVector& of_sector) const {
  NumberVector folded = NumberVector::Zero(map_.size);
  for (Index dof = 0; dof < of_sector.size(); ++dof) {
    const auto i = static_cast<std::size_t>(dof);
    folded(map_.reduced[i]) += map_.is_right[i] ? std::conj(forward_) * of_sector(dof) : of_sector(dof);
  }
  return folded;
}

/// T^H A (T v).
RitzSpace::NumberVector RitzSpace::product(const SparseMatrix& matrix, const NumberVector& unfolded) const {
  NumberVector image = NumberVector::Zero(unfolded.size());
  for (Index j = 0; j < matrix.outerSize(); ++j) {
    for (SparseMatrix::InnerIterator entry(matrix, j); entry; ++entry) {
      image(entry.row()) += static_cast<Real>(entry.value()) * unfolded(j);
    }
  }
  return fold(image);
}

/// Fills the last row and column of V^H A V.
void RitzSpace::widen(Vectors& projection, Index column, const NumberVector& product) {
  projection.conservativeResize(column + 1, column + 1);
  for (Index i = 0; i <= column; ++i) {
    Number sum = 0;
    for (Index dof = 0; dof < product.size(); ++dof)
      sum += std::conj(Number(basis_(dof, i))) * product(dof);
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
    NumberVector unfolded(sector_.mass.rows());
    for (Index dof = 0; dof < unfolded.size(); ++dof) {
      const auto i = static_cast<std::size_t>(dof);
      const Number value = Number(basis_(map_.reduced[i], column));
      unfolded(dof) = map_.is_right[i] ? forward_ * value : value;
    }
    widen(mass_, column, product(sector_.mass, unfolded));
    widen(stiffness_, column, product(sector_.stiffness, unfolded));
    load_(column) = basis_.col(column).cast<Number>().dot(folded_load_);
  }
}

std::vector<Mode> RitzSpace::modes(double below) const {
  const Real shift = below;
  // Of this pencil the lowest modes are the largest and keep all their digits.
  const Vectors shifted = stiffness_ - Number(shift) * mass_;
  if (mass_.llt().info() != Eigen::Success)
    throw SectorError("the mass matrix is not positive definite under this wave");
  if (shifted.llt().info() != Eigen::Success)
    throw SectorError("the stiffness matrix is not positive semidefinite under this wave");
  const Eigen::GeneralizedSelfAdjointEigenSolver<Vectors> solver(mass_, shifted);
  if (solver.info() != Eigen::Success) throw SectorError("the modes of the sector were not found");
  const auto contact = static_cast<std::size_t>(sector_.contacts.front());
  const NumberVector at_contact = basis_.row(map_.reduced[contact]).transpose().cast<Number>();
  const Real two_pi = 2 * std::numbers::pi_v<Real>;
  std::vector<Mode> modes;
  for (Index k = size(); k-- > 0;) {
    const Real theta = solver.eigenvalues()(k);  // 1/(lambda - shift)
    const NumberVector shape = solver.eigenvectors().col(k) / (std::sqrt(theta) * two_pi);
    const Number contact_part = at_contact.conjugate().dot(shape);
    const Number load_part = shape.dot(load_);
    const Real square = std::max(shift + 1 / theta, Real(0));
    modes.push_back({static_cast<double>(std::sqrt(square) / two_pi),
                     static_cast<double>(std::norm(contact_part)), Complex(contact_part * load_part)});
  }
  return modes;
}

}  // namespace arcslip
