#include "arcslip/continuation/linear/eigenvalues.hpp"

#include <Eigen/Eigenvalues>

namespace arcslip::continuation {

ComplexVector eigenvalues(const Matrix& matrix, ComplexMatrix* vectors) {
  const Eigen::EigenSolver<Matrix> solver(matrix, vectors != nullptr);
  if (vectors != nullptr) *vectors = solver.eigenvectors();
  return solver.eigenvalues();
}

}  // namespace arcslip::continuation
