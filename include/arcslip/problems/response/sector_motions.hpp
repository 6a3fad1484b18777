#pragma once

// What each sector of a whole ring does at a solution.

#include "arcslip/problems/response/harmonic_response.hpp"

namespace arcslip::problems {

/// Amplitudes of e^{jwt} in one harmonic, a column for each sector.
struct SectorMotions {
  ComplexMatrix relative;  ///< u - y, a row for each contact of a sector
  ComplexMatrix base;      ///< y, the same
  ComplexMatrix damper;    ///< u, the same
  ComplexMatrix outputs;   ///< a row for each output
};

/// Of a response, in the harmonic at this position among its orders; of one sector a single column.
SectorMotions sector_motions(const HarmonicResponse& problem, const continuation::Guess& at, Index order = 0);

}  // namespace arcslip::problems
