#pragma once

// Natural frequencies of a sector under a travelling wave, by dense matrices.

#include "arcslip/sectors/finite_sector.hpp"

namespace arcslip::testing {

/// Ascending squares of the circular frequencies.
Vector squared_frequencies(const ComplexMatrix& stiffness, const ComplexMatrix& mass);

/// The same of a sector with this wave number.
Vector squared_frequencies(const FiniteSector& sector, Index wave_number, Index sectors);

}  // namespace arcslip::testing
