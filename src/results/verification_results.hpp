#pragma once

// What `arcslip run --verify` finds, as text.

#include "arcslip/problems/tasks/verification.hpp"
#include "arcslip/results/results.hpp"

namespace arcslip {

/// A branch with its points that were solved anew.
struct VerifiedBranch {
  std::size_t number;
  const TracedBranch* traced;
  std::vector<problems::Verification> points;
  std::size_t chosen;     ///< how many were to be solved
  std::string untimed{};  ///< why none was integrated in time, if that cannot be

  bool is_complete() const { return points.size() == chosen; }
};

/// What a branch is that cannot be verified, or "".
std::string why_not_verifiable(const CaseBranch& branch);

/// Solves points of a branch anew, as the options say.
VerifiedBranch verify(std::size_t number, const TracedBranch& traced, problems::VerifyOptions options);

/// The first line of verify.csv, that of a point, and the one that stands for the points of a branch which an
/// interrupt left out.
std::string verification_header();
std::string verification_row(std::size_t number, const TracedBranch& traced,
                             const problems::Verification& point);
std::string interrupted_verification_row(std::size_t number);

/// The first line of offsets.csv, and those of a point; none where no contact sticks for ever.
std::string offsets_header();
std::string offset_rows(std::size_t number, const TracedBranch& traced, const problems::Verification& point);

/// The largest differences of a branch, and how far offsets matter, one line.
std::string describe_verification(const VerifiedBranch& branch);

}  // namespace arcslip
