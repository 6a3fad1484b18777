#pragma once

#include "arcslip/types.hpp"

namespace arcslip {

/// The eigenvalues of a square matrix, the largest modulus first.
ComplexVector spectrum(const Matrix& matrix);
ComplexVector spectrum(const ComplexMatrix& matrix);

/// What is left of a matrix without the subspace that these columns span, which it maps into itself: its
/// other eigenvalues are those of this. Exact where some of them come near those of the subspace, too.
Matrix deflated(const Matrix& matrix, const Matrix& subspace);
ComplexMatrix deflated(const ComplexMatrix& matrix, const ComplexMatrix& subspace);

/// What a square matrix leaves as it is, near a vector (one column) that it hardly changes, by least squares
/// that keep to this one where the matrix tells little: a fold's second multiplier 1 has no vector of its
/// own.
Matrix lasting_near(const Matrix& map, const Matrix& vector);
ComplexMatrix lasting_near(const ComplexMatrix& map, const ComplexMatrix& vector);

/// The vector of an eigenvalue, of length 1.
ComplexVector eigenvector(const ComplexMatrix& matrix, const Complex& value);

}  // namespace arcslip
