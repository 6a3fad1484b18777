#include "arcslip/continuation/bordered_solver.hpp"

#include <stdexcept>

#include "arcslip/continuation/dense_bordered_solver.hpp"
#include "arcslip/continuation/sparse_bordered_solver.hpp"

namespace arcslip::continuation {

BorderedSolver::BorderedSolver(Index size, Index borders)
    : columns_(Matrix::Zero(size, borders)),
      rows_(Matrix::Zero(borders, size)),
      corner_(Matrix::Zero(borders, borders)) {}

void BorderedSolver::set_jacobian(const Matrix& /*jacobian*/, const Vector& /*column_scale*/) {
  throw std::logic_error("set_jacobian: a sparse solver was given a dense Jacobian");
}

void BorderedSolver::set_jacobian(const SparseMatrix& /*jacobian*/, const Vector& /*column_scale*/) {
  throw std::logic_error("set_jacobian: a dense solver was given a sparse Jacobian");
}

std::unique_ptr<BorderedSolver> make_bordered_solver(Index size, Index borders, bool sparse) {
  if (size < 0 || borders < 0) {
    throw std::invalid_argument("make_bordered_solver: neither size nor borders may be negative");
  }
  if (sparse) return std::make_unique<SparseBorderedSolver>(size, borders);
  return std::make_unique<DenseBorderedSolver>(size, borders);
}

}  // namespace arcslip::continuation
