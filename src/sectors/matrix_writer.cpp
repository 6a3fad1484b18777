#include <fmt/format.h>

#include <iterator>

#include "arcslip/sectors/matrix_market.hpp"

namespace arcslip {

std::string write_matrix_market(const SparseMatrix& matrix, MatrixSymmetry symmetry) {
  const bool lower_only = symmetry == MatrixSymmetry::symmetric;
  if (lower_only && (SparseMatrix(matrix.transpose()) - matrix).norm() != 0) {
    throw std::invalid_argument("write_matrix_market: the matrix is not symmetric");
  }
  fmt::memory_buffer entries;
  Index count = 0;
  for (Index j = 0; j < matrix.outerSize(); ++j) {
    for (SparseMatrix::InnerIterator entry(matrix, j); entry; ++entry) {
      if (lower_only && entry.row() < j) continue;
      fmt::format_to(std::back_inserter(entries), "{} {} {:.17g}\n", entry.row() + 1, j + 1, entry.value());
      ++count;
    }
  }
  return fmt::format("%%MatrixMarket matrix coordinate real {}\n{} {} {}\n{}",
                     lower_only ? "symmetric" : "general", matrix.rows(), matrix.cols(), count,
                     fmt::to_string(entries));
}

}  // namespace arcslip
