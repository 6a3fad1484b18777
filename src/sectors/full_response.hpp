#pragma once

// The response of all dofs of a sector at one eta, Z x = f, for what its modes are worth. It is solved for
// from what they give, along directions in their space V and by the factors of the shift that they were found
// with,
//
//   V (V^H Z V)^{-1} V^H r,   (K - sigma M)^{-1} r,   r = f - Z x,
//
// of which the first takes what is low and the second what is high, to the least residual over all of them.
// The residuals are sums in long double of the sector's own matrices. It ends where what the first leaves of
// them is a hundredth of what the modes leave, so that the difference from the modes is known to about as
// much, or where it is the rounding of the matrices' terms; Z itself is never factored.

#include "sectors/extended_sector.hpp"
#include "sectors/krylov_space.hpp"
#include "sectors/ritz_space.hpp"

namespace arcslip {

class FullResponse {
 public:
  /// `space` has found `modes`; `krylov` is none where it spans all dofs. All must outlive this. The modal
  /// part of `loss` has no matrix.
  FullResponse(const RitzSpace& space, const KrylovSpace* krylov, const SectorReduction& reduction,
               const SectorModes& modes, const Loss& loss);

  /// Motions of contacts and outputs (rows) under unit forces on the contacts and under the load (columns),
  /// at a speed in revolutions. Throws SectorError where there is none.
  ComplexMatrix at(double eta, double speed = 0) const;

 private:
  using Real = ExtendedSector::Real;
  using NumberMatrix = ExtendedSector::NumberMatrix;
  class Stiffness;

  NumberMatrix forces() const;
  ComplexMatrix seen(const NumberMatrix& motion) const;

  const RitzSpace& space_;
  const KrylovSpace* krylov_;
  const SectorReduction& reduction_;
  const SectorModes& modes_;
  Loss loss_;
};

}  // namespace arcslip
