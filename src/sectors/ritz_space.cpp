#include "sectors/ritz_space.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace arcslip {

/// Fills the last row and column of V^H A V, of A that is Hermitian or, with `sign` -1, skew.
void RitzSpace::widen(NumberMatrix& projection, Index column, const NumberVector& product, Real sign) {
  projection.conservativeResize(column + 1, column + 1);
  for (Index i = 0; i <= column; ++i) {
    Number sum = 0;
    for (Index dof = 0; dof < product.size(); ++dof) {
      const Real real = basis_(dof, i).real();
      const Real imaginary = basis_(dof, i).imag();
      const Number& value = product(dof);
      sum += Number(real * value.real() + imaginary * value.imag(),
                    real * value.imag() - imaginary * value.real());
    }
    projection(i, column) = sum;
    projection(column, i) = sign * std::conj(sum);
  }
  const Number& own = projection(column, column);
  projection(column, column) = sign > 0 ? Number(own.real()) : Number(0, own.imag());
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
    if (has_gyroscopic_) widen(gyroscopic_, column, sector_.gyroscopic_times(unfolded), -1);
    if (has_stiffness_speed2_) widen(stiffness_speed2_, column, sector_.stiffness_speed2_times(unfolded));
    load_(column) = vector.dot(sector_.load());
  }
}

/// K - shift M, where `shift` < 0 is made no larger than K is, beside which it would lose its digits, and is
/// enlarged until this is definite: by no more than what matrices of a few digits need.
RitzSpace::NumberMatrix RitzSpace::shifted(Real& shift) const {
  constexpr Real least = 1e-15;  // of the largest w*^2
  constexpr Real most = 1e-6;
  const Real largest = (stiffness_.diagonal().real().array() / mass_.diagonal().real().array()).maxCoeff();
  const Real enough = std::max(-shift, most * largest);
  if (largest > 0) shift = -std::clamp(-shift, least * largest, largest);
  for (;; shift *= 10) {
    NumberMatrix definite = stiffness_ - Number(shift) * mass_;
    if (definite.llt().info() == Eigen::Success) return definite;
    if (-shift >= enough)
      throw SectorError("the stiffness matrix is not positive semidefinite under this wave");
  }
}

/// Whether a motion, of unit modal mass, meets no stiffness but the rounding of the matrices as they are
/// written, perhaps with 14 digits; or one below zero that no response at `eta_low` and above can tell from
/// 0.
bool RitzSpace::is_free(const NumberVector& shape, Real square, double eta_low) const {
  constexpr Real digits = 1e-14;
  constexpr Real negligible = 1e-6;
  const Real rounding =
      digits * shape.cwiseAbs().cast<Number>().dot(sector_.stiffness_sums(sector_.unfold(shape))).real();
  const Real low = 2 * std::numbers::pi_v<Real> * static_cast<Real>(eta_low);
  if (square < -std::max(rounding, negligible * low * low))
    throw SectorError("the stiffness matrix is not positive semidefinite under this wave");
  return square <= rounding;
}

SectorModes RitzSpace::modes(const ModesRequest& request) {
  constexpr Real part = 0.1;  // of the window: a smaller shift makes what is divided by worse conditioned
  const Real turn = 2 * std::numbers::pi_v<Real>;
  if (mass_.llt().info() != Eigen::Success)
    throw SectorError("the mass matrix is not positive definite under this wave");
  Real shift = -std::pow(part * turn * static_cast<Real>(request.eta_high), 2);
  // Of this pencil the lowest modes are the largest and keep all their digits.
  const Eigen::GeneralizedSelfAdjointEigenSolver<NumberMatrix> solver(mass_, shifted(shift));
  if (solver.info() != Eigen::Success) throw SectorError("the modes of the sector were not found");
  NumberMatrix observed(sector_.contacts() + sector_.outputs(), size());  // what is seen of each vector
  for (Index i = 0; i < size(); ++i) observed.col(i) = sector_.observed(basis_.col(i).cast<Number>());
  SectorModes found;
  found.shapes.resize(observed.rows(), size());
  found.loads.resize(size());
  NumberMatrix all(size(), size());
  bool free = true;  // as the lowest modes alone may be
  for (Index k = 0; k < size(); ++k) {
    const Index place = size() - 1 - k;
    const Real theta = solver.eigenvalues()(place);  // 1/(lambda - shift)
    const NumberVector shape = solver.eigenvectors().col(place) / std::sqrt(theta);
    const Real square = shift + 1 / theta;
    free = free && is_free(basis_.cast<Number>() * shape, square, request.eta_low);
    if (free) found.free_squares.push_back(static_cast<double>(square / (turn * turn)));
    found.frequencies.push_back(free ? 0 : static_cast<double>(std::sqrt(square) / turn));
    found.shapes.col(k) = (observed * shape / turn).cast<Complex>();
    found.loads(k) = Complex(shape.dot(load_) / turn);
    all.col(k) = shape;
  }
  of_basis_ = (all / turn).cast<Complex>();
  if (has_gyroscopic_) found.gyroscopic = (all.adjoint() * gyroscopic_ * all).cast<Complex>();
  if (has_stiffness_speed2_)
    found.stiffness_speed2 = (all.adjoint() * stiffness_speed2_ * all).cast<Complex>();
  return found;
}

ComplexMatrix RitzSpace::projected(const NumberMatrix& forces) const {
  return of_basis_.adjoint() * (basis_.adjoint() * forces.cast<Complex>());
}

RitzSpace::NumberMatrix RitzSpace::lifted(const ComplexMatrix& of_modes) const {
  return (basis_ * (of_basis_ * of_modes)).cast<Number>();
}

}  // namespace arcslip
