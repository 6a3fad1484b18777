#pragma once

// Matrices and lists of dofs as text: the formats of Matrix Market [Boisvert, Pozo and Remington, The Matrix
// Market exchange formats, NISTIR 5935 (1996)], as finite-element programs write them,
//
//   %%MatrixMarket matrix coordinate real symmetric
//   % comments and blank lines anywhere
//   rows columns entries
//   row column value          one entry a line, indices from 1
//
// or `array` in place of `coordinate`, without indices, column by column.
//
// A text can be hostile: what is allocated is bounded by its length, at most 16 bytes for each of its own and
// 16 MiB besides.

#include <array>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "arcslip/types.hpp"

namespace arcslip {

/// A text that is not in its format. what() is one line: file, line, what was expected and what was given, of
/// which only numbers are quoted unless the text begins as those of matrices do.
class MatrixTextError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Rows that a matrix may have beyond one for each of its entries.
inline constexpr Index most_empty_rows = Index{1} << 19;

/// The square matrix that `text` holds, compressed, in coordinate or array format, general, symmetric or
/// Hermitian (the lower triangle given), or skew-symmetric (what is below the diagonal), with real or integer
/// values, or complex ones without imaginary part. Entries given more than once are summed. `file` is its
/// name in errors. Throws MatrixTextError.
SparseMatrix read_matrix_market(std::string_view text, const std::string& file);

/// The same of a skew-symmetric matrix G, which may also be given as the Hermitian one jG: complex and
/// Hermitian, without real parts. Throws MatrixTextError.
SparseMatrix read_gyroscopic(std::string_view text, const std::string& file);

/// Refuses a text that does not begin as those of matrices do. `beginning` holds its first line at least.
/// Throws MatrixTextError.
void check_banner(std::string_view beginning, const std::string& file);

/// The dofs that `text` lists, separated by blanks or lines, numbered from 1 to `size` in the text and from 0
/// in the result; what follows % or # on a line is a comment. Throws MatrixTextError.
std::vector<Index> read_dofs(std::string_view text, const std::string& file, Index size);

/// The force on each of `size` dofs that `text` gives in lines "dof value [imaginary part]", dofs and
/// comments as above; forces on one dof are summed. Throws MatrixTextError.
ComplexVector read_load(std::string_view text, const std::string& file, Index size);

/// Where a dof is in the sector of phase 0, with the z axis as that of the turning, and the direction in
/// which it moves.
struct DofPlace {
  std::array<double, 3> at;         ///< x, y, z
  std::array<double, 3> direction;  ///< of unit length
};

/// The places of all `size` dofs that `text` gives in lines "dof x y z dx dy dz", dofs and comments as above,
/// directions of any length but 0. Throws MatrixTextError.
std::vector<DofPlace> read_places(std::string_view text, const std::string& file, Index size);

enum class MatrixSymmetry { general, symmetric };

/// `matrix` in the format above with 17 digits, so that reading it gives the same numbers. Throws
/// std::invalid_argument where it is to be symmetric and is not, to the last digit.
std::string write_matrix_market(const SparseMatrix& matrix, MatrixSymmetry symmetry);

}  // namespace arcslip
