#pragma once

// Natural frequencies of a sector under a travelling wave, by dense matrices.

#include <Eigen/Eigenvalues>

#include "arcslip/sector_reduction.hpp"
#include "sector_examples.hpp"

namespace arcslip::testing {

/// Ascending squares of the circular frequencies with this wave number.
inline Vector squared_frequencies(const FiniteSector& sector, Index wave_number, Index sectors) {
  SectorReduction reduction(sector);
  reduction.set_forward(forward(wave_number, sectors));
  const Eigen::GeneralizedSelfAdjointEigenSolver<ComplexMatrix> modes(
      ComplexMatrix(reduction.stiffness()), ComplexMatrix(reduction.mass()), Eigen::EigenvaluesOnly);
  return modes.eigenvalues();
}

}  // namespace arcslip::testing
