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

/// Where a branch turns into its own image: it had lost a symmetry, has it again, and leaves the place along
/// a direction t with S t = -t, so that what follows is the image of what came before.
class OwnImage {
 public:
  /// `tolerance`: as of kept_symmetries.
  OwnImage(std::vector<Symmetry> symmetries, double tolerance);

  /// Takes the next point of the branch, with its tangent (n + 1, over the scale) and scale (n + 1, that of
  /// the parameter last). The symmetry that makes it such a place, or null.
  const Symmetry* take(const Vector& u, const Vector& tangent, const Vector& scale);

  /// Whether a point, with its tangent and scale, lies on a branch that has a symmetry which this one has
  /// lost: no smooth branch comes to it, a step has gone over.
  bool has_gone_over(const Vector& u, const Vector& tangent, const Vector& scale) const;

 private:
  std::vector<Symmetry> symmetries_;
  double tolerance_;
  std::vector<double> farthest_;  // that the branch has been from having each
};

}  // namespace arcslip::continuation
