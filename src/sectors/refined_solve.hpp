#pragma once

// Solutions of (k K(a) + m M(a)) x = f that keep the digits of a double: by LU factors of that matrix, with
// residuals in long double from the sector's own matrices, whose sums K(a) and M(a) cancel.

#include "sectors/complex_factors.hpp"
#include "sectors/extended_sector.hpp"

namespace arcslip {

/// `factors` are those of k K(a) + m M(a) in double. Ends with a correction of at most `accuracy`, relative.
ExtendedSector::NumberVector refined_solve(const ExtendedSector& sector, ComplexFactors& factors,
                                           ExtendedSector::Number k, ExtendedSector::Number m,
                                           const ExtendedSector::NumberVector& force,
                                           ExtendedSector::Real accuracy);

}  // namespace arcslip
