#pragma once

// What `arcslip run --verify` finds, as text.

#include "arcslip/problems/verification.hpp"
#include "arcslip/results.hpp"

namespace arcslip {

/// A branch with its points that were solved anew.
struct VerifiedBranch {
  std::size_t number;
  const TracedBranch* traced;
  std::vector<problems::Verification> points;
};

/// What a branch is that cannot be verified, or "".
std::string why_not_verifiable(const CaseBranch& branch);

/// Solves points of a branch anew.
VerifiedBranch verify(std::size_t number, const TracedBranch& traced,
                      const std::function<bool(std::size_t, std::size_t)>& progress);

/// verify.csv, in pieces.
void write_verification(const std::vector<VerifiedBranch>& branches, const Sink& sink);

/// The largest differences of a branch, one line.
std::string describe_verification(const VerifiedBranch& branch);

}  // namespace arcslip
