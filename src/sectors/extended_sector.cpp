#include "sectors/extended_sector.hpp"

#include <cmath>
#include <numbers>

namespace arcslip {
namespace {

/// Of a symmetric matrix, whose columns are its rows.
ExtendedSector::NumberVector product(const SparseMatrix& matrix, const ExtendedSector::NumberVector& v) {
  ExtendedSector::NumberVector image(v.size());
  for (Index j = 0; j < matrix.outerSize(); ++j) {
    ExtendedSector::Number sum = 0;
    for (SparseMatrix::InnerIterator entry(matrix, j); entry; ++entry)
      sum += static_cast<ExtendedSector::Real>(entry.value()) * v(entry.row());
    image(j) = sum;
  }
  return image;
}

}  // namespace

ExtendedSector::ExtendedSector(const FiniteSector& sector, const SectorWave& wave)
    : sector_(sector), map_(sector_map(sector)) {
  const Real a =
      2 * std::numbers::pi_v<Real> * static_cast<Real>(wave.wave_number) / static_cast<Real>(wave.sectors);
  forward_ = {std::cos(a), -std::sin(a)};
  if (2 * wave.wave_number % wave.sectors == 0) forward_.imag(0);  // modes are real then
  load_ = fold(sector.load.cast<Number>());
}

ExtendedSector::NumberVector ExtendedSector::unfold(const NumberVector& reduced) const {
  NumberVector unfolded(sector_.mass.rows());
  for (Index dof = 0; dof < unfolded.size(); ++dof) {
    const auto i = static_cast<std::size_t>(dof);
    const Number value = reduced(map_.reduced[i]);
    unfolded(dof) = map_.is_right[i] ? forward_ * value : value;
  }
  return unfolded;
}

ExtendedSector::NumberVector ExtendedSector::fold(const NumberVector& of_sector) const {
  NumberVector folded = NumberVector::Zero(map_.size);
  for (Index dof = 0; dof < of_sector.size(); ++dof) {
    const auto i = static_cast<std::size_t>(dof);
    folded(map_.reduced[i]) += map_.is_right[i] ? std::conj(forward_) * of_sector(dof) : of_sector(dof);
  }
  return folded;
}

ExtendedSector::NumberVector ExtendedSector::mass_times(const NumberVector& unfolded) const {
  return fold(product(sector_.mass, unfolded));
}

ExtendedSector::NumberVector ExtendedSector::stiffness_times(const NumberVector& unfolded) const {
  return fold(product(sector_.stiffness, unfolded));
}

ExtendedSector::NumberVector ExtendedSector::gyroscopic_times(const NumberVector& unfolded) const {
  return fold(-product(sector_.gyroscopic, unfolded));
}

ExtendedSector::NumberVector ExtendedSector::stiffness_speed2_times(const NumberVector& unfolded) const {
  return fold(product(sector_.stiffness_speed2, unfolded));
}

ExtendedSector::NumberVector ExtendedSector::sums(const SparseMatrix& matrix,
                                                  const NumberVector& unfolded) const {
  const Eigen::Matrix<Real, Eigen::Dynamic, 1> sizes = unfolded.cwiseAbs();
  NumberVector folded = NumberVector::Zero(map_.size);
  for (Index j = 0; j < matrix.outerSize(); ++j) {
    Real sum = 0;
    for (SparseMatrix::InnerIterator entry(matrix, j); entry; ++entry)
      sum += static_cast<Real>(std::abs(entry.value())) * sizes(entry.row());
    folded(map_.reduced[static_cast<std::size_t>(j)]) += sum;
  }
  return folded;
}

ExtendedSector::NumberVector ExtendedSector::stiffness_sums(const NumberVector& unfolded) const {
  return sums(sector_.stiffness, unfolded);
}

ExtendedSector::NumberVector ExtendedSector::mass_sums(const NumberVector& unfolded) const {
  return sums(sector_.mass, unfolded);
}

ExtendedSector::NumberVector ExtendedSector::contact_force(Index contact) const {
  const auto i = static_cast<std::size_t>(contact);
  const auto reduced = [&](Index dof) { return map_.reduced[static_cast<std::size_t>(dof)]; };
  NumberVector force = NumberVector::Unit(map_.size, reduced(sector_.contacts[i]));
  if (sector_.against_of(i) != FiniteSector::ground) force(reduced(sector_.against_of(i))) = -1;
  return force;
}

ExtendedSector::NumberVector ExtendedSector::observed(const NumberVector& reduced) const {
  NumberVector values(contacts() + outputs());
  for (Index i = 0; i < contacts(); ++i) values(i) = (contact_force(i).transpose() * reduced).value();
  for (Index i = 0; i < outputs(); ++i) {
    const auto dof = static_cast<std::size_t>(sector_.outputs[static_cast<std::size_t>(i)]);
    const Number value = reduced(map_.reduced[dof]);
    values(contacts() + i) = map_.is_right[dof] ? forward_ * value : value;
  }
  return values;
}

}  // namespace arcslip
