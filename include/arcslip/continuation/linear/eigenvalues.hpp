#pragma once

#include "arcslip/types.hpp"

namespace arcslip::continuation {

/// All eigenvalues of a square matrix, conjugates together, and their vectors of length 1 in the columns of
/// `vectors` where it is given.
ComplexVector eigenvalues(const Matrix& matrix, ComplexMatrix* vectors = nullptr);

}  // namespace arcslip::continuation
