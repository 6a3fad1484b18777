#pragma once

#include "arcslip/types.hpp"

namespace arcslip {

/// The eigenvalues of a square matrix, the largest modulus first.
ComplexVector spectrum(const Matrix& matrix);

}  // namespace arcslip
