#pragma once

// Matrices of square blocks, of which those on each diagonal are the same, round the corner too:
//
//   A_ij = B((i - j) mod N) = (1/N) sum_m b(m) e^{-2 pi j m (i - j)/N},
//
// as of sectors round a ring. Sums, products and inverses are those of the b(m).

#include "arcslip/types.hpp"

namespace arcslip {

/// e^{-2 pi j m i/N}, N x N.
ComplexMatrix wave_turns(Index blocks);

/// Inverts such a matrix of so many rows of blocks in place, in the time of its transformation. False, and
/// nothing changed, where it is none.
[[nodiscard]] bool invert_block_circulant(ComplexMatrix& a, Index blocks);

}  // namespace arcslip
