// What intervals of an orbit make of changes at their left ends, in several of them side by side.

#include "arcslip/continuation/linear/blocks_side_by_side.hpp"
#include "orbit_scratch.hpp"

namespace arcslip::continuation {
namespace {

constexpr Index lanes = BlocksSideBySide::lanes;

/// The equations of each, by df/du at its points and by its length times T with the sign changed: of the
/// inner nodes, then of the right end and of the left.
void fill(const CollocationRule& rule, Index n, const double* by_unknowns, const double* lengths,
          BlocksSideBySide& blocks) {
  const Index m = rule.degree();
  double weights[lanes];
  for (Index i = 0; i < m; ++i) {
    for (Index k = 0; k <= m; ++k) {
      for (Index l = 0; l < lanes; ++l) weights[l] = lengths[l] * rule.values()(i, k);
      const double* entry = by_unknowns + i * n * n * lanes;
      for (Index c = 0; c < n; ++c) {
        double* const column = blocks.at(i * n, (k + m) % (m + 1) * n + c);
        for (Index r = 0; r < n; ++r, entry += lanes) {
          for (Index l = 0; l < lanes; ++l) column[r * lanes + l] = weights[l] * entry[l];
        }
        for (Index l = 0; l < lanes; ++l) column[c * lanes + l] += rule.derivatives()(i, k);
      }
    }
  }
}

}  // namespace

bool OrbitProblem::transfers(const Vector& u, const Vector& p, const Regime& regime,
                             std::vector<Matrix>& out) const {
  const OrbitFrame& at = frame(regime);
  const CollocationRule& rule = at.mesh.rule();
  const Index n = field_->size();
  const Index m = degree();
  const double length = duration(u, p);
  Scratch scratch(*this, p.size());
  BlocksSideBySide blocks(n * m, n * (m + 1), n * m);
  Matrix by_unknowns(lanes, m * n * n);
  double lengths[lanes];
  out.assign(static_cast<std::size_t>(intervals()), Matrix(n, n));
  for (Index first = 0; first < intervals(); first += scratch.together) {
    if (!at_points(at, u, p, length, first, true, scratch)) return false;
    const Index end = std::min(first + scratch.together, intervals());
    for (Index j = first; j < end; j += lanes) {
      const auto interval = [&](Index lane) { return std::min(j + lane, end - 1); };
      for (Index lane = 0; lane < lanes; ++lane) {
        lengths[lane] = -at.mesh.length(interval(lane)) * length;
        const double* const entries = scratch.entries((interval(lane) - first) * m);
        for (Index k = 0; k < by_unknowns.cols(); ++k) by_unknowns(lane, k) = entries[k];
      }
      fill(rule, n, by_unknowns.data(), lengths, blocks);
      blocks.eliminate();
      blocks.solve_last(n);
      for (Index lane = 0; lane < lanes; ++lane) {
        Matrix& transfer = out[static_cast<std::size_t>(interval(lane))];
        for (Index c = 0; c < n; ++c) {
          for (Index r = 0; r < n; ++r) transfer(r, c) = -blocks.at(n * (m - 1) + r, n * m + c)[lane];
        }
      }
    }
  }
  return true;
}

}  // namespace arcslip::continuation
