#include "arcslip/continuation/linear/bordered_solver.hpp"

#include <algorithm>
#include <stdexcept>

#include "arcslip/continuation/linear/dense_bordered_solver.hpp"
#include "arcslip/continuation/linear/sparse_bordered_solver.hpp"

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

void BorderedSolver::set_jacobian(const CondensedJacobian& /*jacobian*/, const Vector& /*column_scale*/) {
  throw std::logic_error("set_jacobian: another solver was given a condensed Jacobian");
}

double permutation_sign(const int* image, std::vector<char>& seen) {
  std::fill(seen.begin(), seen.end(), char{0});
  double sign = 1;
  for (std::size_t start = 0; start < seen.size(); ++start) {
    if (seen[start] != 0) continue;
    // A cycle of length l has the sign (-1)^(l - 1).
    for (auto i = static_cast<std::size_t>(image[start]); i != start;
         i = static_cast<std::size_t>(image[i])) {
      seen[i] = 1;
      sign = -sign;
    }
  }
  return sign;
}

std::unique_ptr<BorderedSolver> make_bordered_solver(Index size, Index borders, bool sparse) {
  if (size < 0 || borders < 0) {
    throw std::invalid_argument("make_bordered_solver: neither size nor borders may be negative");
  }
  if (sparse) return std::make_unique<SparseBorderedSolver>(size, borders);
  return std::make_unique<DenseBorderedSolver>(size, borders);
}

}  // namespace arcslip::continuation
