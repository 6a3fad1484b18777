#pragma once

// Which problem a branch solves: among the unknowns that have the symmetries which all of it has.

#include <map>
#include <memory>

#include "arcslip/continuation/path/branch.hpp"
#include "arcslip/continuation/path/tolerances.hpp"
#include "arcslip/continuation/problem/guess.hpp"
#include "arcslip/continuation/problem/symmetric_problem.hpp"

namespace arcslip::continuation {

/// Keeps the problem by reference, and what it makes of it.
class SymmetricBranches {
 public:
  /// Of a sparse problem symmetries are not made use of.
  SymmetricBranches(const Problem& problem, const Tolerances& tolerances);

  const Problem& whole() const { return problem_; }

  /// The problem of a branch that leaves a solution along a direction, if there is one: null where they have
  /// no symmetry in common.
  const SymmetricProblem* around(const Vector& unknowns, const Vector& parameters, const Vector& direction);

  /// The same, of which the guess is made one to rounding; the whole problem where there is no symmetry.
  const Problem& of(Guess& guess);

  /// In which problems the branches lie that leave a branch point: those of its branch's symmetries that
  /// they keep, or all.
  std::vector<const Problem*> leaving(const BranchPoint& point);

 private:
  const SymmetricProblem* with(const Subgroup& kept, double size);
  double size(const Vector& unknowns, const Vector& parameters) const;

  const Problem& problem_;
  Tolerances tolerances_;
  std::shared_ptr<const SymmetryGroup> group_;
  std::map<Subgroup, std::unique_ptr<SymmetricProblem>> known_;
};

/// What is lost at a branch point at which a branch loses symmetries.
struct LostSymmetries {
  Index null_vectors = 0;          ///< of dF/du
  std::vector<std::string> names;  ///< of those that not all of these have
};

/// Of a branch point of a branch with symmetries; nothing is lost where branches meet that have the same.
LostSymmetries lost_symmetries(const Problem& problem, const SymmetryGroup& group, const BranchPoint& point,
                               const Tolerances& tolerances = {});

}  // namespace arcslip::continuation
