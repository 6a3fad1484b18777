#pragma once

// Sparse LU factorisation of complex matrices that share one pattern of entries: KLU of SuiteSparse [Davis
// and Natarajan, ACM Trans. Math. Softw. 37 (2010) 36], whose order of elimination serves them all, and whose
// pivots serve the next matrix as long as they are good.

#include <klu.h>

#include "arcslip/sector_reduction.hpp"

namespace arcslip {

class ComplexFactors {
 public:
  /// Analyses the pattern. Throws std::bad_alloc and std::length_error.
  explicit ComplexFactors(ComplexSparseMatrix& pattern);
  ~ComplexFactors();
  ComplexFactors(const ComplexFactors&) = delete;
  ComplexFactors& operator=(const ComplexFactors&) = delete;

  /// False where the matrix is singular to rounding of its pivots.
  bool factor(ComplexSparseMatrix& matrix);

  /// Smallest over largest pivot, of rows that are scaled.
  double pivot_ratio() const { return common_.rcond; }

  void solve(ComplexMatrix& columns);             ///< A^{-1} columns, in place
  void solve_transposed(ComplexMatrix& columns);  ///< A^{-T} columns, in place

  /// Factorisations with new pivots, and with those of the one before.
  int full() const { return full_; }
  int quick() const { return quick_; }

 private:
  bool factor_with_old_pivots(ComplexSparseMatrix& matrix);
  bool factor_with_new_pivots(ComplexSparseMatrix& matrix);
  bool regular();
  double growth(ComplexSparseMatrix& matrix);
  void check_memory() const;

  klu_common common_{};
  klu_symbolic* symbolic_ = nullptr;
  klu_numeric* numeric_ = nullptr;
  double chosen_growth_ = 1;
  int full_ = 0;
  int quick_ = 0;
};

}  // namespace arcslip
