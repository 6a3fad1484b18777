#pragma once

// What shift-invert Lanczos adds to the space in which the modes of a sector are found, block by block:
// x_1 = (K - sigma M)^{-1} [e F], then (K - sigma M)^{-1} M x_1 and so on, orthonormal in M.
//
// sigma = 0 makes the static response exact. It serves where K is positive definite in double and no motion
// far below the window rules that response. Otherwise, as where the structure is free to move as a whole,
// sigma is below zero by a tenth of the window, so that neither rounding nor such a motion drowns what is
// elastic.
//
// Solutions keep the digits of a double: residuals are in long double, from the sector's own matrices, whose
// sums K(a) and M(a) cancel.

#include "sectors/cholesky.hpp"
#include "sectors/extended_sector.hpp"

namespace arcslip {

class KrylovSpace {
 public:
  /// For responses in the window of `request`. All but this must outlive it; `reduction` is of the sector
  /// under the wave. Throws SectorError.
  KrylovSpace(const ExtendedSector& sector, const SectorReduction& reduction, const ModesRequest& request);

  /// The next orthonormal vectors; none where the space has all that matters.
  const ComplexMatrix& next();

  /// (K - sigma M)^{-1} columns, in place.
  void solve(ComplexMatrix& columns) const { factors_.solve(columns); }

  int factorisations() const { return factorisations_; }

 private:
  bool factor(double sigma);
  ComplexMatrix refined(const ComplexMatrix& forces) const;
  bool is_static(const ModesRequest& request);
  double norm(const ComplexVector& v) const;
  ComplexVector outside(const ComplexVector& v) const;
  void append(ComplexVector v);

  const ExtendedSector& extended_;
  const SectorReduction& reduction_;
  ComplexSparseMatrix shifted_;
  Cholesky<Complex> factors_;
  int factorisations_ = 0;
  double sigma_ = 0;
  ComplexMatrix basis_;
  ComplexMatrix block_;
};

}  // namespace arcslip
