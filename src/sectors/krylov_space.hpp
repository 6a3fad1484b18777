#pragma once

// What shift-invert Lanczos adds to the space in which the modes of a sector are found, block by block:
// x_1 = (K - sigma M)^{-1} [e F], then (K - sigma M)^{-1} M x_1 and so on, orthonormal in M.
//
// sigma = 0 makes the static response exact. It serves where K is regular in double and no motion far below
// the window rules that response. Otherwise, as where the structure is free to move as a whole, sigma is
// below zero by a tenth of the window, so that neither rounding nor such a motion drowns what is elastic.

#include "sectors/complex_factors.hpp"
#include "sectors/extended_sector.hpp"

namespace arcslip {

class KrylovSpace {
 public:
  /// For responses in the window of `request`. `sector` must outlive this. Throws SectorError.
  KrylovSpace(const FiniteSector& sector, const SectorWave& wave, const ModesRequest& request);

  /// The next orthonormal vectors; none where the space has all that matters.
  const ComplexMatrix& next();

  int factorisations() const { return factors_.factorisations(); }

 private:
  bool is_static(const ModesRequest& request);
  double norm(const ComplexVector& v) const;
  void append(ComplexVector v);

  ExtendedSector extended_;
  SectorReduction reduction_;
  ComplexSparseMatrix shifted_;
  ComplexFactors factors_;
  double sigma_ = 0;
  ComplexMatrix basis_;
  ComplexMatrix block_;
};

}  // namespace arcslip
