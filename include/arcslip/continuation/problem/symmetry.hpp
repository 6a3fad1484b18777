#pragma once

// Symmetries of a problem: linear maps S of the unknowns under which F(S u, p) = S F(u, p), so that they map
// solutions to solutions. Where a branch loses some of those that its parent has, its images under these are
// branches as well, which nobody needs to trace.

#include <string>
#include <vector>

#include "arcslip/types.hpp"

namespace arcslip::continuation {

/// One that is not the identity.
struct Symmetry {
  std::string name;  ///< what people call it
  SparseMatrix map;  ///< S, n x n
};

/// Which of them a solution has: S u = u to `tolerance` of each unknown's scale (n).
std::vector<bool> kept_symmetries(const std::vector<Symmetry>& symmetries, const Vector& u,
                                  const Vector& scale, double tolerance);

}  // namespace arcslip::continuation
