#pragma once

// Sparse LU factorisation of complex matrices that share one pattern of entries: SuperLU [Demmel, Eisenstat,
// Gilbert, Li & Liu, SIAM J. Matrix Anal. Appl. 20 (1999) 720], with pivots from the diagonal where they
// serve, in an order of least fill that is found once for them all.

#include <memory>

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

  void solve(ComplexMatrix& columns);             ///< A^{-1} columns, in place
  void solve_transposed(ComplexMatrix& columns);  ///< A^{-T} columns, in place

  /// Frees the factors until the next ones.
  void release();

  int factorisations() const { return factorisations_; }

 private:
  struct Parts;

  std::unique_ptr<Parts> parts_;
  int factorisations_ = 0;
};

}  // namespace arcslip
