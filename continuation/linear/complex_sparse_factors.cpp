#include "arcslip/continuation/linear/complex_sparse_factors.hpp"

#include <Eigen/SparseLU>
#include <cmath>

namespace arcslip::continuation {

struct ComplexSparseFactors::Solver : Eigen::SparseLU<ComplexSparse> {
  using SparseLU::SparseLU;
};

ComplexSparseFactors::ComplexSparseFactors(const ComplexSparse& matrix)
    : solver_(std::make_shared<Solver>(matrix)) {}

ComplexVector ComplexSparseFactors::solve(const ComplexVector& right) const {
  if (solver_->info() != Eigen::Success) return ComplexVector::Constant(right.size(), std::nan(""));
  return solver_->solve(right);
}

ComplexVector ComplexSparseFactors::solve_adjoint(const ComplexVector& right) const {
  if (solver_->info() != Eigen::Success) return ComplexVector::Constant(right.size(), std::nan(""));
  return solver_->adjoint().solve(right);
}

}  // namespace arcslip::continuation
