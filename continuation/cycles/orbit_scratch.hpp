#pragma once

#include <algorithm>

#include "arcslip/continuation/cycles/orbit_problem.hpp"

namespace arcslip::continuation {

/// What is found of the field at the points of some intervals, side by side.
struct OrbitProblem::Scratch {
  Scratch(const OrbitProblem& problem, Index parameters) {
    const Index groups =
        problem.field().sparse() ? problem.intervals() : 1 + problem.intervals() * problem.degree() / most;
    together = (problem.intervals() + groups - 1) / groups;
    const Index n = problem.field().size();
    const Index points = together * problem.degree();
    const CollocationRule& rule = problem.frames_.front()->mesh.rule();
    values = rule.values().transpose();
    derivatives = rule.derivatives().transpose();
    times.resize(points);
    for (Matrix* one : {&places, &changes, &velocities}) one->resize(n, points);
    by_parameters.resize(n, parameters * points);
    blocks.resize(problem.degree() * problem.block_.nonZeros());
    if (problem.field().is_periodic()) by_time.resize(n, points);
    weights.resize(blocks.size(), problem.degree() + 1);
    const int* const begins = problem.block_.outerIndexPtr();
    for (Index k = 0; k < weights.cols(); ++k) {
      for (Index c = 0, at = 0; c < n; ++c) {
        const Index count = begins[c + 1] - begins[c];
        for (Index i = 0; i < problem.degree(); ++i, at += count)
          weights.col(k).segment(at, count).setConstant(rule.values()(i, k));
      }
    }
    if (problem.field().sparse()) {
      sparse_by_unknowns.assign(static_cast<std::size_t>(points), problem.block_);
    } else {
      by_unknowns.resize(n, n * points);
    }
  }

  /// df/du of one, the entries of the block.
  const double* entries(Index point) const {
    if (!sparse_by_unknowns.empty()) return sparse_by_unknowns[static_cast<std::size_t>(point)].valuePtr();
    return by_unknowns.data() + point * by_unknowns.rows() * by_unknowns.rows();
  }
  auto by_unknowns_at(Index point) const {
    return by_unknowns.middleCols(point * by_unknowns.rows(), by_unknowns.rows());
  }
  auto by_parameters_at(Index point) const {
    const Index count = by_parameters.cols() / times.size();
    return by_parameters.middleCols(point * count, count);
  }

  Matrix values;                     // of the rule, those of a point side by side, and
  Matrix derivatives;                // these
  static constexpr Index most = 64;  // points: few enough to stay near
  Index together = 1;                // intervals
  Vector times;
  Matrix places;
  Matrix velocities;  // f
  Matrix changes;     // sum_k D_ik u_k
  Matrix by_unknowns;
  Matrix by_parameters;
  Matrix by_time;
  Vector blocks;                                 // of an interval's points, see fill_blocks
  Matrix weights;                                // of these at each node
  std::vector<SparseMatrix> sparse_by_unknowns;  // of a sparse field, in place of the others
};

}  // namespace arcslip::continuation
