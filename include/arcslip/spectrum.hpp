#pragma once

#include "arcslip/types.hpp"

namespace arcslip {

/// The eigenvalues of a square matrix, the largest modulus first.
ComplexVector spectrum(const Matrix& matrix);
ComplexVector spectrum(const ComplexMatrix& matrix);

/// The vector of an eigenvalue, of length 1.
ComplexVector eigenvector(const ComplexMatrix& matrix, const Complex& value);

}  // namespace arcslip
