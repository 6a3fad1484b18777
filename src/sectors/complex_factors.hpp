#pragma once

// Sparse LU factorisation of complex matrices that share one pattern of entries: UMFPACK of SuiteSparse
// [Davis, ACM Trans. Math. Softw. 30 (2004) 196], whose symbolic analysis serves them all.

#include <array>

#include "arcslip/sectors/sector_reduction.hpp"

namespace arcslip {

class ComplexFactors {
 public:
  /// Analyses the pattern. Throws std::bad_alloc and std::length_error.
  explicit ComplexFactors(const ComplexSparseMatrix& pattern);
  ~ComplexFactors();
  ComplexFactors(const ComplexFactors&) = delete;
  ComplexFactors& operator=(const ComplexFactors&) = delete;

  /// False where the matrix, of this pattern, is singular. Throws std::bad_alloc.
  bool factor(const ComplexSparseMatrix& matrix);

  /// Smallest over largest pivot, of rows that are scaled.
  double pivot_ratio() const { return pivot_ratio_; }

  void solve(ComplexMatrix& columns);             ///< A^{-1} columns, in place
  void solve_transposed(ComplexMatrix& columns);  ///< A^{-T} columns, in place

  /// Frees the factors until the next ones.
  void release();

  int factorisations() const { return factorisations_; }

 private:
  void solve(int system, ComplexMatrix& columns);

  std::array<double, 20> control_{};
  void* symbolic_ = nullptr;
  void* numeric_ = nullptr;
  double pivot_ratio_ = 0;
  int factorisations_ = 0;
  ComplexVector right_;
};

}  // namespace arcslip
