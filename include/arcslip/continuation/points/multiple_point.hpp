#pragma once

// Branch points at which several eigenvalues vanish at once.

#include <optional>
#include <vector>

#include "arcslip/continuation/path/tolerances.hpp"
#include "arcslip/continuation/problem/guess.hpp"
#include "arcslip/continuation/problem/problem.hpp"

namespace arcslip::continuation {

/// A branch point at which two eigenvalues or more vanish at once, as where symmetries are lost: [dF/du
/// dF/dp_a] has as many null vectors more than elsewhere on a branch. Of two, on the null space z = y_0 t + E
/// x around the branch with the direction y_0 that is known, the other branches solve
///
///   t b x + q(x) = 0,  and where q leaves t undetermined in x,  r b x + c(x) = 0,
///
/// q of the second order, c of the third and r the bend along y_0: b x and what is beside it are parallel.
struct MultiplePoint {
  Guess at;                        ///< as its own conditions have it, which hold it across all branches
  bool is_double = false;          ///< two eigenvalues; else more, and no direction is told
  std::vector<Vector> directions;  ///< of the other branches, n + 1; none where these terms do not tell
  bool is_whole = true;            ///< whether these are all, as far as such terms go
};
/// At a point of a branch along `branch.direction`; none where that is regular or a simple branch point.
[[nodiscard]] std::optional<MultiplePoint> multiple_point(const Problem& problem, Index active,
                                                          const Guess& branch, const Tolerances& tolerances);

}  // namespace arcslip::continuation
