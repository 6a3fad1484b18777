#pragma once

// A sparse Jacobian, and what its factors tell of it.

#include <vector>

#include "arcslip/continuation/linear/blocks_side_by_side.hpp"
#include "arcslip/types.hpp"

namespace arcslip::continuation {

/// What the elimination of those columns that blocks of rows have alone leaves of each: its last rows, in its
/// other columns, times a power of two. It is that of the factors made last.
struct RowsLeft {
  const std::vector<BlocksSideBySide>& batches;  ///< of blocks side by side
  Index count;                                   ///< of blocks
  Index rows;                                    ///< left of each
  Index first;                                   ///< of these rows, and of the other columns
  Eigen::MatrixX<int> columns;                   ///< which they are, ascending; one column for each block
};

/// dF/du of a sparse problem.
struct FactoredJacobian {
  const SparseMatrix& entries;
  const RowsLeft* left = nullptr;  ///< null where it was not factored by blocks
  const Vector* scale = nullptr;   ///< of columns: factors are those of dF/du diag(scale)
};

}  // namespace arcslip::continuation
