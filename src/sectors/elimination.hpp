#pragma once

// In what order, and in what dense blocks, sparse matrices of a symmetric pattern are eliminated: nested
// dissection by METIS [Karypis & Kumar, SIAM J. Sci. Comput. 20 (1998) 359] where it was found when this was
// built, else approximate minimum degree; columns whose entries come to be in the same rows, or nearly so,
// make one front [Liu, SIAM Review 34 (1992) 82].

#include <string>
#include <vector>

#include "arcslip/types.hpp"

namespace arcslip {

/// Of an array.
constexpr std::size_t subscript(int i) { return static_cast<std::size_t>(i); }

/// The pattern of a sparse matrix of so many rows, compressed by columns, with both triangles.
struct SymmetricPattern {
  int size;
  const int* begin;  ///< of each column in `rows`, and the end of the last
  const int* rows;   ///< ascending in each column
};

template <class Sparse>
SymmetricPattern symmetric_pattern(const Sparse& compressed) {
  return {static_cast<int>(compressed.rows()), compressed.outerIndexPtr(), compressed.innerIndexPtr()};
}

/// The rows in an order of elimination that leaves few entries. Throws std::bad_alloc and std::length_error.
std::vector<int> least_fill_order(const SymmetricPattern& pattern);

/// Who finds it: "METIS" or "AMD".
std::string least_fill_library();

class Elimination {
 public:
  /// Columns that are eliminated together; places count in the order of elimination.
  struct Front {
    int first;              ///< place of its first column
    int width;              ///< of columns
    std::vector<int> rows;  ///< places of the rows below them that they have entries in, ascending
    int parent;             ///< the front that these are passed on to; -1: none

    std::size_t height() const { return static_cast<std::size_t>(width) + rows.size(); }
  };

  /// Throws std::bad_alloc and std::length_error.
  explicit Elimination(const SymmetricPattern& pattern);

  const std::vector<int>& order() const { return order_; }      ///< the row at each place
  const std::vector<int>& place() const { return place_; }      ///< and the place of each row
  const std::vector<Front>& fronts() const { return fronts_; }  ///< children before their parents

 private:
  void find_order(const SymmetricPattern& pattern);
  std::vector<int> entry_counts(const SymmetricPattern& pattern, const std::vector<int>& parents) const;
  void find_fronts(const std::vector<int>& parents, const std::vector<int>& counts);
  void find_rows(const SymmetricPattern& pattern);

  std::vector<int> order_, place_;
  std::vector<Front> fronts_;
};

}  // namespace arcslip
