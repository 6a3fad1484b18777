#pragma once

// What rotation adds to the space in which the modes of a sector are found: at a speed Omega the vectors of
//
//   K' x_k = M x_{k-2} - j Omega G x_{k-1},   K' = K + Omega^2 K_2,   x_1 = K'^{-1} [e F],
//
// from which the response at any w near 0 follows as a series [second-order Arnoldi: Bai and Su, SIAM J.
// Matrix Anal. Appl. 26 (2005) 640], and with an engine order m, Omega = w/m, those of
//
//   K x_k = (M - K_2/m^2 - j G/m) x_{k-1}.

#include <memory>

#include "sectors/cholesky.hpp"
#include "sectors/extended_sector.hpp"

namespace arcslip {

/// All vectors of the space, those at rest included, orthonormal in M.
class TurningSpace {
 public:
  /// For the rotations of `request`. `reduction`, of the sector under the wave, must outlive this. Throws
  /// SectorError.
  TurningSpace(const ExtendedSector& sector, const SectorReduction& reduction, const ModesRequest& request);
  ~TurningSpace();
  TurningSpace(const TurningSpace&) = delete;
  TurningSpace& operator=(const TurningSpace&) = delete;

  /// Takes further vectors of reduced dofs into the space, and gives what they add to it.
  ComplexMatrix take(const ComplexMatrix& vectors);

  /// What the next vectors of all rotations add; nothing where the space has all that matters.
  ComplexMatrix next();

 private:
  class Sequence;

  const SectorReduction& reduction_;
  ComplexMatrix basis_;
  std::vector<std::unique_ptr<Sequence>> sequences_;
};

}  // namespace arcslip
