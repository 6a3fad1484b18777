#pragma once

// Which parts of a sparse matrix are eliminated side by side.

#include <vector>

#include "arcslip/types.hpp"

namespace arcslip::continuation {

/// Rows that follow each other and have the same columns, or two groups of such.
struct AlikeBlock {
  std::vector<int> rows;
  std::vector<int> inner;  ///< columns that no other rows have, but those that stay
  std::vector<int> outer;  ///< the others
};

/// Which rows and columns of a matrix go into blocks of one size, and which are left.
struct AlikeParts {
  std::vector<AlikeBlock> blocks;
  std::vector<int> staying;  ///< rows
  std::vector<int> others;   ///< rows that are in no block
  std::vector<int> columns;  ///< that are left
};

/// Of a matrix of this pattern, of which the last `borders` rows stay to the end, as do those that are nearly
/// full. With `pairs` blocks are made of two groups that share columns with no others. Without blocks where
/// there are too few.
AlikeParts find_alike_parts(const SparseMatrix& pattern, Index borders, bool pairs);

/// The pattern with all entries that blocks have.
SparseMatrix with_full_blocks(const SparseMatrix& pattern, const std::vector<AlikeBlock>& blocks);

}  // namespace arcslip::continuation
