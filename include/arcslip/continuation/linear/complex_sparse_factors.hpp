#pragma once

#include <memory>

#include "arcslip/types.hpp"

namespace arcslip::continuation {

using ComplexSparse = Eigen::SparseMatrix<Complex>;

/// The triangular factors of a square, sparse, complex matrix.
class ComplexSparseFactors {
 public:
  explicit ComplexSparseFactors(const ComplexSparse& matrix);

  /// x of A x = right; nan of a singular A.
  [[nodiscard]] ComplexVector solve(const ComplexVector& right) const;

  /// x of A^H x = right.
  [[nodiscard]] ComplexVector solve_adjoint(const ComplexVector& right) const;

 private:
  struct Solver;
  std::shared_ptr<Solver> solver_;
};

}  // namespace arcslip::continuation
