#pragma once

// Pseudo-arclength continuation of F(u, p) = 0 in one parameter, through regimes with located borders.

#include <functional>
#include <string>
#include <vector>

#include "arcslip/continuation/branch.hpp"
#include "arcslip/continuation/problem.hpp"

namespace arcslip::continuation {

/// Where a branch starts: a guess of the unknowns at the given parameters, in a regime.
struct Guess {
  Vector unknowns;
  Vector parameters;
  int regime = 0;
};

struct TraceOptions {
  std::string parameter;                ///< the continuation parameter, by name
  double from = 0;                      ///< its first value; the guess's is replaced by it
  double to = 1;                        ///< its last value, on which the branch ends exactly
  std::vector<double> stop_at;          ///< values to put a `user` point on, in any order
  std::vector<std::string> extrema_of;  ///< observables whose extrema become `peak` and `trough` points
  double tolerance = 1e-10;             ///< on the largest entry of F
  double max_step = 0.1;                ///< largest step, in scaled arclength
  double min_step = 1e-10;              ///< smallest step; a branch that asks for less has ended
  long max_points = 100000;
};

/// Called at each point stored; false ends the branch as `interrupted`.
using Observer = std::function<bool(const BranchPoint&)>;

/// Traces the branch from `options.from` to `options.to`. A branch that cannot be traced to its end holds
/// what was traced and says why. Throws std::invalid_argument for options that do not fit the problem.
Branch trace(const Problem& problem, const Guess& guess, const TraceOptions& options,
             const Observer& observer = {});

}  // namespace arcslip::continuation
