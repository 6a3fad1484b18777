#include "arcslip/continuation/cycles/doubling_problem.hpp"

namespace arcslip::continuation {

DoublingProblem::DoublingProblem(const CycleProblem& base, Index active)
    : SingularProblem(base, active, base.size() - (base.has_duration() ? 1 : 0)),
      unknowns_(base.field().size()) {}

void DoublingProblem::fill(BorderedSolver& solver) const {
  SparseMatrix twisted = at_.sparse_jacobian().topLeftCorner(count_, count_);
  for (Index column = 0; column < unknowns_; ++column) {
    for (SparseMatrix::InnerIterator entry(twisted, column); entry; ++entry) {
      if (entry.row() >= count_ - unknowns_) entry.valueRef() *= -1;
    }
  }
  twisted.makeCompressed();
  solver.set_jacobian(twisted, scale_);
}

}  // namespace arcslip::continuation
