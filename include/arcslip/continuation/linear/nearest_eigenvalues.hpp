#pragma once

#include "arcslip/types.hpp"

namespace arcslip::continuation {

/// How many of a sparse equilibrium tell its stability.
inline constexpr Index eigenvalues_looked_at = 20;

/// As many eigenvalues of a square sparse matrix as wished for that are nearest to 0, conjugates together, or
/// one more or less for that; all of a matrix with no more than 200 rows. Their vectors of length 1 are in
/// the columns of `vectors` where it is given. By Arnoldi's method on the inverse, so that each factorises
/// once; of an eigenvalue that repeats exactly one copy is found. None where it does not converge.
ComplexVector nearest_eigenvalues(const SparseMatrix& matrix, Index count, ComplexMatrix* vectors = nullptr);

}  // namespace arcslip::continuation
