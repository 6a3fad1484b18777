#pragma once

// Which branches of a case can be proven, and their proofs.

#include "arcslip/cases/runs.hpp"

namespace arcslip {

/// What of this request cannot be certified and why, or empty.
std::string why_not_certifiable(const CaseBranch& request);

/// Proves a traced branch that can be certified, and stores the certificate in it.
void certify(TracedBranch& traced);

}  // namespace arcslip
