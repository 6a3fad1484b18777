#pragma once

// What rows of a matrix are multiplied by before pivots are chosen: powers of two, which round nothing.

#include "arcslip/types.hpp"

namespace arcslip::continuation {

/// The power of two that scales x > 0 to between 1 and 2.
double scale_to_one(double x);

/// Those for the largest entries of rows, one for each. False if a row is zero.
[[nodiscard]] bool find_row_scale(const SparseMatrix& matrix, Vector& scale);

}  // namespace arcslip::continuation
