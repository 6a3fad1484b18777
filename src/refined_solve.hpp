#pragma once

// Solutions that have all digits of a double, of (k K(a) + m M(a)) x = f: by LU factors of that matrix, with
// residuals in long double from the sector's own matrices, whose sums K(a) and M(a) cancel.

#include "complex_factors.hpp"
#include "extended_sector.hpp"

namespace arcslip {

/// `factors` are those of k K(a) + m M(a) in double.
ExtendedSector::NumberVector refined_solve(const ExtendedSector& sector, ComplexFactors& factors,
                                           ExtendedSector::Number k, ExtendedSector::Number m,
                                           const ExtendedSector::NumberVector& force);

}  // namespace arcslip
