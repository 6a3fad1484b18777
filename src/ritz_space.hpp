#pragma once

// The projection of a sector on given vectors and its modes there, in long double.

#include "arcslip/sector_modes.hpp"
#include "arcslip/sector_reduction.hpp"

namespace arcslip {

class RitzSpace {
 public:
  /// `sector` must outlive this.
  RitzSpace(const FiniteSector& sector, const SectorWave& wave);

  /// Widens the space by the columns, vectors of reduced dofs.
  void add(const ComplexMatrix& columns);

  Index size() const { return mass_.rows(); }

  /// All modes in the space. `below` < 0 is a shift in w*^2 that makes K - below M definite. Throws SectorError.
  std::vector<Mode> modes(double below) const;

 private:
  using Real = long double;
  using Number = std::complex<Real>;
  using Vectors = Eigen::Matrix<Number, Eigen::Dynamic, Eigen::Dynamic>;
  using NumberVector = Eigen::Matrix<Number, Eigen::Dynamic, 1>;

  NumberVector fold(const NumberVector& of_sector) const;
  NumberVector product(const SparseMatrix& matrix, const NumberVector& unfolded) const;
  void widen(Vectors& projection, Index column, const NumberVector& product);

  const FiniteSector& sector_;
  SectorMap map_;
  Number forward_;
  NumberVector folded_load_;
  ComplexMatrix basis_;
  Vectors mass_;
  Vectors stiffness_;
  NumberVector load_;
};

}  // namespace arcslip
