#pragma once

#include <algorithm>

#include "arcslip/continuation/cycles/orbit_problem.hpp"

namespace arcslip::continuation {

/// What is found of the field at the points of some intervals, side by side.
struct OrbitProblem::Scratch {
  /// One of this thread, which allocates where a problem differs from the last one in size.
  static Scratch& of(const OrbitProblem& problem, Index parameters) {
    thread_local Scratch scratch;
    scratch.fit(problem, parameters);
    return scratch;
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

  Index together = 1;  // intervals
  Vector times;
  Matrix places;
  Matrix velocities;  // f
  Matrix changes;     // sum_k D_ik u_k
  Matrix by_unknowns;
  Matrix by_parameters;
  Matrix by_time;                                // of a periodic field
  Vector blocks;                                 // of an interval's points, see fill_blocks
  Vector in_units;                               // of these points, that of the frame for each
  std::vector<SparseMatrix> sparse_by_unknowns;  // of a sparse field, in place of the others

 private:
  void fit(const OrbitProblem& problem, Index parameters) {
    constexpr Index most = 64;  // points: few enough to stay near
    const bool is_sparse = problem.field().sparse();
    const Index groups = is_sparse ? problem.intervals() : 1 + problem.intervals() * problem.degree() / most;
    together = (problem.intervals() + groups - 1) / groups;
    const Index n = problem.field().size();
    const Index points = together * problem.degree();
    times.resize(points);
    for (Matrix* one : {&places, &changes, &velocities}) one->resize(n, points);
    by_parameters.resize(n, parameters * points);
    blocks.resize(problem.degree() * problem.block_.nonZeros());
    by_time.resize(n, problem.field().is_periodic() ? points : 0);
    by_unknowns.resize(n, is_sparse ? 0 : n * points);
    sparse_by_unknowns.assign(is_sparse ? static_cast<std::size_t>(points) : 0, problem.block_);
  }
};

}  // namespace arcslip::continuation
