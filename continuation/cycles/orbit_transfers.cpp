// What intervals of an orbit make of changes at their left ends, in several of them side by side.

#include <algorithm>

#include "arcslip/continuation/cycles/orbit_problem.hpp"
#include "arcslip/continuation/linear/blocks_side_by_side.hpp"

namespace arcslip::continuation {

/// The equations of each interval are entries of the Jacobian that stand together: of the inner nodes, then
/// of the right end and of the left. The conditions at the ends of the orbit stand above them.
std::vector<Matrix> OrbitProblem::transfers(const SparseMatrix& jacobian) const {
  constexpr Index lanes = BlocksSideBySide::lanes;
  const Index n = field_->size();
  const Index m = degree();
  const Index rows = n * m;
  BlocksSideBySide blocks(rows, rows + n, rows);
  std::vector<Matrix> out(static_cast<std::size_t>(intervals()), Matrix(n, n));
  for (Index first = 0; first < intervals(); first += lanes) {
    const auto interval = [&](Index lane) { return std::min(first + lane, intervals() - 1); };
    for (Index k = 0; k <= m; ++k) {
      for (Index c = 0; c < n; ++c) {
        const double* entries[lanes];
        for (Index lane = 0; lane < lanes; ++lane) {
          const Index node = interval(lane) * m + k;
          const bool is_end = node == 0 || node + 1 == nodes();
          const bool is_second = k == 0 && node > 0;  // those of the interval before come first
          entries[lane] = jacobian.valuePtr() + jacobian.outerIndexPtr()[node * n + c] +
                          (is_end ? end_entries() : 0) + (is_second ? rows : 0);
        }
        double* column = blocks.at(0, (k + m) % (m + 1) * n + c);
        for (Index r = 0; r < rows; ++r, column += lanes) {
          for (Index lane = 0; lane < lanes; ++lane) column[lane] = entries[lane][r];
        }
      }
    }
    blocks.eliminate();
    blocks.solve_last(n);
    for (Index lane = 0; lane < lanes; ++lane) {
      Matrix& transfer = out[static_cast<std::size_t>(interval(lane))];
      for (Index c = 0; c < n; ++c) {
        for (Index r = 0; r < n; ++r) transfer(r, c) = -blocks.at(rows - n + r, rows + c)[lane];
      }
    }
  }
  return out;
}

}  // namespace arcslip::continuation
