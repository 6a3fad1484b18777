#pragma once

// Curves of special points in two parameters, through those of branches.

#include "arcslip/cases/runs.hpp"

namespace arcslip {

using Request = std::shared_ptr<const CaseBranch>;

/// Of what could not be begun.
TracedBranch unstarted(const Request& request, const Subject& subject, const std::string& why);

/// The curve through each special point of the branches across, over the first parameter, that is asked for,
/// but once.
std::vector<TracedBranch> trace_curves(const Request& request, const Subject& subject,
                                       const std::vector<TracedBranch>& across,
                                       const continuation::TimeBudget& time,
                                       const continuation::Observer& observer);

}  // namespace arcslip
