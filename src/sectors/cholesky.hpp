#pragma once

// Cholesky factorisation L L^H of sparse matrices that are Hermitian and positive definite and share one
// pattern of entries, front by front [Duff & Reid, ACM Trans. Math. Softw. 9 (1983) 302]: the dense blocks
// are the matter of BLAS and LAPACK. It takes half the operations and the memory of an LU factorisation.

#include "arcslip/sectors/sector_reduction.hpp"
#include "sectors/elimination.hpp"

namespace arcslip {

/// Of real or complex matrices.
template <class Scalar>
class Cholesky {
 public:
  using Sparse = Eigen::SparseMatrix<Scalar>;
  using Dense = Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic>;

  /// Analyses the pattern of both triangles. Throws std::bad_alloc and std::length_error.
  explicit Cholesky(const Sparse& pattern);

  /// False where the matrix, of this pattern, is not positive definite. Throws std::bad_alloc.
  bool factor(const Sparse& matrix);

  /// The row at which the last one was found not to be.
  Index indefinite_at() const { return indefinite_at_; }

  /// A^{-1} columns, in place.
  void solve(Dense& columns) const;

 private:
  using Front = Elimination::Front;

  void assemble(const Sparse& matrix, const Front& front, Scalar* panel, std::vector<int>& within) const;
  bool eliminate(const Front& front, Scalar* panel, Dense& update);
  void forward(Dense& x) const;
  void backward(Dense& x) const;

  Elimination elimination_;
  std::vector<std::size_t> begin_;  // of each front's columns in `values_`
  std::vector<Scalar> values_;
  Index indefinite_at_ = -1;
};

extern template class Cholesky<double>;
extern template class Cholesky<Complex>;

}  // namespace arcslip
