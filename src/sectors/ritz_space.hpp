#pragma once

// The projection of a sector on given vectors and its modes there, in long double.

#include "sectors/extended_sector.hpp"

namespace arcslip {

class RitzSpace {
 public:
  /// `sector` must outlive this. With what rotation adds where it `turns`.
  RitzSpace(const FiniteSector& sector, const SectorWave& wave, bool turns)
      : sector_(sector, wave),
        has_gyroscopic_(turns && sector.gyroscopic.size() != 0),
        has_stiffness_speed2_(turns && sector.stiffness_speed2.size() != 0),
        basis_(sector_.size(), 0) {}

  /// Widens the space by the columns, vectors of reduced dofs.
  void add(const ComplexMatrix& columns);

  Index size() const { return mass_.rows(); }

  /// All modes in the space, with their residues, for responses in the window of `request`. Throws
  /// SectorError.
  SectorModes modes(const ModesRequest& request);

  using NumberMatrix = ExtendedSector::NumberMatrix;

  /// What forces on the reduced dofs, a column each, do to the modes last found, V^H f/(2 pi), and how the
  /// dofs move as these do, V q/(2 pi).
  ComplexMatrix projected(const NumberMatrix& forces) const;
  NumberMatrix lifted(const ComplexMatrix& of_modes) const;

  const ExtendedSector& sector() const { return sector_; }

 private:
  using Real = ExtendedSector::Real;
  using Number = ExtendedSector::Number;
  using NumberVector = ExtendedSector::NumberVector;

  void widen(NumberMatrix& projection, Index column, const NumberVector& product, Real sign = 1);
  NumberMatrix shifted(Real& shift) const;
  bool is_free(const NumberVector& shape, Real square, double eta_low) const;

  ExtendedSector sector_;
  bool has_gyroscopic_;
  bool has_stiffness_speed2_;
  ComplexMatrix basis_;
  NumberMatrix mass_;
  NumberMatrix stiffness_;
  NumberMatrix gyroscopic_;
  NumberMatrix stiffness_speed2_;
  NumberVector load_;
  ComplexMatrix of_basis_;  // modes, over 2 pi, as sums of the vectors
};

}  // namespace arcslip
