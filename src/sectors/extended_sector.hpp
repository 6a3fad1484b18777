#pragma once

// A sector under a travelling wave in long double, without forming K(a), whose entries cancel:
//
//   A(a) v = T^H (A (T v)),   A the sector's own matrix

#include "arcslip/sectors/finite_sector.hpp"
#include "arcslip/sectors/sector_modes.hpp"

namespace arcslip {

class ExtendedSector {
 public:
  using Real = long double;
  using Number = std::complex<Real>;
  using NumberVector = Eigen::Matrix<Number, Eigen::Dynamic, 1>;
  using NumberMatrix = Eigen::Matrix<Number, Eigen::Dynamic, Eigen::Dynamic>;

  /// `sector` must outlive this.
  ExtendedSector(const FiniteSector& sector, const SectorWave& wave);

  NumberVector unfold(const NumberVector& reduced) const;  ///< T v
  NumberVector fold(const NumberVector& of_sector) const;  ///< T^H f

  /// A(a) v of M, K, G and K_2, from T v.
  NumberVector mass_times(const NumberVector& unfolded) const;
  NumberVector stiffness_times(const NumberVector& unfolded) const;
  NumberVector gyroscopic_times(const NumberVector& unfolded) const;
  NumberVector stiffness_speed2_times(const NumberVector& unfolded) const;

  /// |A| |v| of K and M, of the sector's own entries, from T v: what may cancel in A(a) v.
  NumberVector stiffness_sums(const NumberVector& unfolded) const;
  NumberVector mass_sums(const NumberVector& unfolded) const;

  const NumberVector& load() const { return load_; }  ///< T^H F
  Index size() const { return map_.size; }
  Index contacts() const { return std::ssize(sector_.contacts); }
  /// A unit force on a contact, on reduced dofs: its column of E.
  NumberVector contact_force(Index contact) const;
  Index outputs() const { return std::ssize(sector_.outputs); }
  /// The contacts and then the outputs of a reduced vector.
  NumberVector observed(const NumberVector& reduced) const;

 private:
  NumberVector sums(const SparseMatrix& matrix, const NumberVector& unfolded) const;

  const FiniteSector& sector_;
  SectorMap map_;
  Number forward_;
  NumberVector load_;
};

}  // namespace arcslip
