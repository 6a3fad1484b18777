#pragma once

// Cycles of flows and boundary value problems, in what a case asks for.

#include "arcslip/cases/runs.hpp"
#include "arcslip/continuation/cycles/torus.hpp"

namespace arcslip {

/// The problem of a branch whose solutions are cycles; null of others and of curves.
const continuation::PeriodicOrbit* cycles_of(const TracedBranch& traced);

/// The same of all whose solutions are orbits: cycles, and solutions of boundary value problems.
const continuation::OrbitProblem* orbits_of(const TracedBranch& traced);

/// The same of those whose solutions are tori.
const continuation::Torus* torus_of(const TracedBranch& traced);

/// Whether the branch is one of a boundary value problem or of cycles made of pieces.
bool has_orbits_alone(const CaseBranch& request);

/// Whether the branch is one of cycles from its start on: by `settle`, or of a system that depends on time.
bool asks_for_cycles(const CaseBranch& request);

/// Whether Hopf points of this problem's solutions lead to cycles that are followed.
bool may_leave_cycles(const continuation::Problem& problem);

/// The cycles that can be reached from the Hopf points of branches.
std::vector<TracedBranch> cycles_leaving(const std::vector<TracedBranch>& traced,
                                         const continuation::TimeBudget& time,
                                         const continuation::Observer& observer);

/// The branch of a cycle on which the motion from the subject's guess settles; with `switching` all that can
/// be reached from it.
std::vector<TracedBranch> trace_settled_cycles(const std::shared_ptr<const CaseBranch>& request,
                                               const Subject& subject, const continuation::TimeBudget& time,
                                               const continuation::Observer& observer);

/// The branch of a boundary value problem from its guess; with `switching` all that can be reached from it.
std::vector<TracedBranch> trace_from_orbit(const std::shared_ptr<const CaseBranch>& request,
                                           const Subject& subject, const continuation::TimeBudget& time,
                                           const continuation::Observer& observer);

}  // namespace arcslip
