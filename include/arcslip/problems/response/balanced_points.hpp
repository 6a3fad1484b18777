#pragma once

// Forced responses of one harmonic and one contact, whose unknown is a logarithm, beside those in any number
// of both, as points of the latter.

#include <memory>
#include <vector>

#include "arcslip/assembly/system.hpp"
#include "arcslip/continuation/path/branch.hpp"
#include "arcslip/problems/response/forced_response.hpp"
#include "arcslip/problems/response/harmonic_response.hpp"

namespace arcslip::problems {

/// The response of a system in other orders than its own. Throws SectorError.
HarmonicResponse balanced(SystemParameters parameters, std::vector<int> orders);

/// The points of a branch of HarmonicResponse or ForcedResponse as those of the first.
class BalancedPoints {
 public:
  /// The branch has the system of `parameters` in `orders`. Throws SectorError.
  BalancedPoints(const SystemParameters& parameters, const std::vector<int>& orders,
                 const continuation::Branch& branch);

  /// What the points are solutions of.
  const HarmonicResponse& problem() const { return problem_; }

  /// One of the branch.
  continuation::Guess at(const continuation::BranchPoint& point) const;

 private:
  HarmonicResponse problem_;
  std::unique_ptr<ForcedResponse> scalar_;  // of which the branch is, or null
};

}  // namespace arcslip::problems
