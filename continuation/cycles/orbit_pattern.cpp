// Where the Jacobian of collocation has entries.

#include <algorithm>
#include <stdexcept>

#include "arcslip/continuation/cycles/orbit_problem.hpp"

namespace arcslip::continuation {

/// All entries of what is dense.
void OrbitProblem::build_block(const Matrix& orbit, const Vector& p) {
  const Index n = field_->size();
  if (!field_->sparse()) {
    block_ = Matrix::Ones(n, n).sparseView();
    for (Index c = 0; c < n; ++c) diagonal_.push_back(c);
    return;
  }
  SparseMatrix of_field(n, n);
  FieldValues wanted;
  wanted.sparse_by_unknowns = &of_field;
  if (!field_->evaluate(0, orbit.col(0), p, wanted))
    throw std::invalid_argument("an orbit begins where its field has no value");
  SparseMatrix identity(n, n);
  identity.setIdentity();
  for (double& entry : of_field.coeffs()) entry = 1;
  block_ = of_field + identity;
  block_.makeCompressed();
  const int* const rows = block_.innerIndexPtr();
  for (Index c = 0; c < n; ++c) {
    const int* const begin = rows + block_.outerIndexPtr()[c];
    const int* const end = rows + block_.outerIndexPtr()[c + 1];
    diagonal_.push_back(std::lower_bound(begin, end, static_cast<int>(c)) - begin);
    for (SparseMatrix::InnerIterator entry(of_field, c); entry; ++entry) {
      const int* const found = std::lower_bound(begin, end, entry.row());
      places_.push_back(static_cast<int>(found - rows));
    }
  }
}

void OrbitProblem::build_weights(const CollocationRule& rule) {
  padded_values_.setZero((degree() + fours - 1) / fours * fours, degree() + 1);
  padded_values_.topRows(degree()) = rule.values();
  padded_slopes_.setZero(padded_values_.rows(), degree() + 1);
  padded_slopes_.topRows(degree()) = rule.derivatives();
  weights_.resize(degree() * block_.nonZeros(), degree() + 1);
  const int* const begins = block_.outerIndexPtr();
  for (Index k = 0; k <= degree(); ++k) {
    for (Index c = 0, at = 0; c < block_.cols(); ++c) {
      const Index count = begins[c + 1] - begins[c];
      for (Index i = 0; i < degree(); ++i, at += count)
        weights_.col(k).segment(at, count).setConstant(rule.values()(i, k));
    }
  }
}

/// Columns of nodes hold the rows of each interval that they are on, those of the ends the conditions as
/// well; that of T holds all but these. The conditions stand first and each Gauss point beside the node after
/// it, as a march in time would find them: pivots from the diagonal keep what decays from growing.
void OrbitProblem::build_pattern() {
  const Index n = field_->size();
  const Index rows = n * degree();
  pattern_.resize(size(), size());
  for (Index node = 0; node < nodes(); ++node) {
    const Index j = node / degree();
    const bool is_border = node % degree() == 0;
    const bool is_end = node == 0 || node + 1 == nodes();
    for (Index c = 0; c < n; ++c) {
      const Index column = node * n + c;
      pattern_.startVec(column);
      for (Index i = 0; i < end_entries() && is_end; ++i)
        pattern_.insertBack(field_->sparse() ? c : i, column) = 0;
      const Index first = is_border && j > 0 ? j - 1 : j;
      const Index last = std::min(j, intervals() - 1);
      for (Index row = n + first * rows; row < n + (last + 1) * rows; row += n) {
        for (SparseMatrix::InnerIterator entry(block_, c); entry; ++entry)
          pattern_.insertBack(row + entry.row(), column) = 0;
      }
      if (has_duration_) pattern_.insertBack(size() - 1, column) = 0;
    }
  }
  if (has_duration_) {
    pattern_.startVec(size() - 1);
    for (Index row = n; row < size() - 1; ++row) pattern_.insertBack(row, size() - 1) = 0;
  }
  pattern_.finalize();
  pattern_.makeCompressed();
}

}  // namespace arcslip::continuation
