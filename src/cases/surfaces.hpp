#pragma once

// Surfaces of solutions over two parameters.

#include "arcslip/cases/runs.hpp"

namespace arcslip {

/// Through the guess, or through all solutions at its parameters where these are asked for.
TracedBranch cover_surface(const std::shared_ptr<const CaseBranch>& request, const Subject& subject,
                           const continuation::TimeBudget& time);

}  // namespace arcslip
