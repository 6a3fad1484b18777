#pragma once

// The projection of a sector on given vectors and its modes there, in long double.

#include "sectors/extended_sector.hpp"

namespace arcslip {

class RitzSpace {
 public:
  /// `sector` must outlive this.
  RitzSpace(const FiniteSector& sector, const SectorWave& wave)
      : sector_(sector, wave), basis_(sector_.size(), 0) {}

  /// Widens the space by the columns, vectors of reduced dofs.
  void add(const ComplexMatrix& columns);

  Index size() const { return mass_.rows(); }

  /// All modes in the space, with their residues, for responses in the window of `request`. Throws
  /// SectorError.
  SectorModes modes(const ModesRequest& request) const;

 private:
  using Real = ExtendedSector::Real;
  using Number = ExtendedSector::Number;
  using NumberVector = ExtendedSector::NumberVector;
  using NumberMatrix = ExtendedSector::NumberMatrix;

  void widen(NumberMatrix& projection, Index column, const NumberVector& product);
  NumberMatrix shifted(Real& shift) const;
  bool is_free(const NumberVector& shape, Real square, double eta_low) const;

  ExtendedSector sector_;
  ComplexMatrix basis_;
  NumberMatrix mass_;
  NumberMatrix stiffness_;
  NumberVector load_;
};

}  // namespace arcslip
