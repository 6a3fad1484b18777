#pragma once

// How a sparse matrix goes through fronts.

#include <cstddef>
#include <vector>

#include "arcslip/types.hpp"

namespace arcslip::continuation {

/// A dense matrix, of which some columns are eliminated.
struct Front {
  int first = 0;               // its first pivot in the order of all: of its rows as well
  int rows = 0;                // that may give pivots
  int height = 0;              // these and those that stay to the end
  int stride = 0;              // from column to column: this, or up to three more
  int pivots = 0;              // the columns that are eliminated, its first ones
  int columns = 0;             // all
  std::vector<int> kept;       // where the other columns are in the order of all
  std::vector<int> carried;    // where these are that the front before has kept
  std::vector<int> entries;    // which entries of the matrix enter,
  std::vector<int> places;     // and where
  std::ptrdiff_t values = 0;   // where it begins among all fronts' values
  std::vector<int> exchanged;  // the row that came to each pivot's place
};

/// Which rows enter in which order, and when columns are eliminated.
struct FrontPlan {
  std::vector<int> row_order;     // those that stay at the end
  std::vector<int> column_order;  // of elimination
  std::vector<Front> fronts;
  double multiplications = 0;
};

/// Rows with more entries than this are nearly full, as conditions on all unknowns are.
Index most_of_a_row(const SparseMatrix& matrix);

/// For matrices of this pattern, of which the last `borders` rows stay to the end, as do those that are
/// nearly full. Without fronts where the rows of one do not suffice for its columns, or where all cost more
/// than `most` multiplications.
FrontPlan plan_fronts(const SparseMatrix& pattern, Index borders, double most);

}  // namespace arcslip::continuation
