// What intervals of an orbit make of changes at their left ends, in several of them side by side.

#include <algorithm>

#include "arcslip/continuation/cycles/orbit_problem.hpp"

namespace arcslip::continuation {

namespace {

constexpr Index lanes = BlocksSideBySide::lanes;

}  // namespace

/// Whether what is left is one block for each interval, in the values at its ends.
bool OrbitProblem::is_left_of_intervals(const RowsLeft& left) const {
  const Index n = field_->size();
  if (left.count != intervals() || left.rows != n || left.columns.rows() < 2 * n) return false;
  for (Index j = 0; j < intervals(); ++j) {
    for (Index c = 0; c < n; ++c) {
      const Index at_left = j * degree() * n + c;
      if (left.columns(c, j) != at_left || left.columns(n + c, j) != at_left + degree() * n) return false;
    }
  }
  return true;
}

/// The equations of each interval are entries of the Jacobian that stand together: of the inner nodes, then
/// of the right end and of the left. The conditions at the ends of the orbit stand above them.
void OrbitProblem::take_interval(const SparseMatrix& jacobian, Index interval, Index lane,
                                 BlocksSideBySide& out) const {
  const Index n = field_->size();
  const Index m = degree();
  const Index rows = n * m;
  for (Index k = 0; k <= m; ++k) {
    const Index node = interval * m + k;
    const bool is_end = node == 0 || node + 1 == nodes();
    const bool is_second = k == 0 && node > 0;  // those of the interval before come first
    for (Index c = 0; c < n; ++c) {
      const double* const entries = jacobian.valuePtr() + jacobian.outerIndexPtr()[node * n + c] +
                                    (is_end ? end_entries() : 0) + (is_second ? rows : 0);
      double* const column = out.at(0, (k + m) % (m + 1) * n + c) + lane;
      for (Index r = 0; r < rows; ++r) column[r * lanes] = entries[r];
    }
  }
}

std::vector<Matrix> OrbitProblem::transfers(const FactoredJacobian& jacobian) const {
  const Index n = field_->size();
  const bool are_left = jacobian.left != nullptr && is_left_of_intervals(*jacobian.left);
  const Index rows = are_left ? n : n * degree();
  BlocksSideBySide blocks(rows, rows + n, rows);
  std::vector<Matrix> out(static_cast<std::size_t>(intervals()), Matrix(n, n));
  for (Index first = 0; first < intervals(); first += lanes) {
    const auto interval = [&](Index lane) { return std::min(first + lane, intervals() - 1); };
    if (are_left) {
      const BlocksSideBySide& from = jacobian.left->batches[static_cast<std::size_t>(first / lanes)];
      const Index at = jacobian.left->first;
      for (Index c = 0; c < n; ++c) {
        std::copy_n(from.at(at, at + c), n * lanes, blocks.at(0, n + c));
        std::copy_n(from.at(at, at + n + c), n * lanes, blocks.at(0, c));
      }
    } else {
      for (Index lane = 0; lane < lanes; ++lane)
        take_interval(jacobian.entries, interval(lane), lane, blocks);
    }
    blocks.eliminate();
    blocks.solve_last(n);
    for (Index lane = 0; lane < lanes; ++lane) {
      Matrix& transfer = out[static_cast<std::size_t>(interval(lane))];
      for (Index c = 0; c < n; ++c) {
        for (Index r = 0; r < n; ++r) transfer(r, c) = -blocks.at(rows - n + r, rows + c)[lane];
      }
      if (!are_left) continue;
      const auto scale = jacobian.scale->segment(interval(lane) * degree() * n, (degree() + 1) * n);
      transfer.array().colwise() *= scale.tail(n).array();
      transfer.array().rowwise() /= scale.head(n).transpose().array();
    }
  }
  return out;
}

/// Of each node's columns what their own unknowns do at the points of an interval.
double OrbitProblem::growth_of_volumes(const OrbitFrame& frame, const SparseMatrix& jacobian) const {
  const double* const weights = frame.mesh.rule().weights().data();
  const Index n = field_->size();
  const Index count = intervals();
  double sum = 0;
  for (Index c = 0; c < n; ++c) {
    const Index stride = block_.outerIndexPtr()[c + 1] - block_.outerIndexPtr()[c];
    const double* const values = jacobian.valuePtr() + diagonal_[static_cast<std::size_t>(c)];
    const int* const starts = jacobian.outerIndexPtr() + c;
    with_degree(degree(), [&](auto m) {
      double all = 0;
      for (Index j = 0; j < count; ++j) {
        for (Index k = 0; k <= m; ++k) {
          const bool is_end = (j == 0 && k == 0) || (j + 1 == count && k == m);
          const bool is_second = k == 0 && j > 0;  // those of the interval before come first
          const double* const entries =
              values + starts[(j * m + k) * n] + (is_end ? end_entries() : 0) + (is_second ? m * stride : 0);
          for (Index i = 0; i < m; ++i) all += weights[i] * entries[i * stride];
        }
      }
      sum -= all / frame.in_units(c);
    });
  }
  return sum;
}

}  // namespace arcslip::continuation
