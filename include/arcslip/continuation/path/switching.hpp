#pragma once

// From one branch to the others that it meets.

#include <vector>

#include "arcslip/continuation/path/trace.hpp"

namespace arcslip::continuation {

/// The ways that leave a special point of a branch, other than the branch's own: at a branch point both ways
/// along the other branch, at a switch all further pieces that meet on its borders. Guesses with a direction,
/// as `trace` takes them; none where nothing leaves.
std::vector<Guess> other_ways(const Problem& problem, const std::string& parameter, const BranchPoint& point,
                              const Tolerances& tolerances = {});

/// What is followed.
struct FollowOptions {
  /// Whether both senses in which a way leaves a given point are images of each other, by a symmetry that is
  /// lost there: one is enough.
  bool images = false;
};

/// What is said where more leave, at this value of the parameter, than were followed.
std::string more_branches(std::size_t followed, const std::string& parameter, double at);

/// A branch and all that can be reached from it through branch points and corners, each way once and of those
/// that are images of each other under the problem's symmetries one, in the order in which they are met. The
/// first one is traced as `trace` does it.
std::vector<Branch> trace_connected(const Problem& problem, const Guess& guess, const TraceOptions& options,
                                    const Observer& observer = {});

/// The same through solutions at one value of the parameter, from which the first branches are traced both
/// ways as `trace_through` does it.
std::vector<Branch> trace_connected_through(const Problem& problem, const std::vector<Guess>& solutions,
                                            const TraceOptions& options, const Observer& observer = {});

/// What leaves special points of branches that are known, and all that can be reached from that.
std::vector<Branch> trace_leaving(const Problem& problem, const std::vector<BranchPoint>& points,
                                  const TraceOptions& options, const FollowOptions& follow = {},
                                  const Observer& observer = {});

/// The branches through solutions at one value of the parameter, as `solve_all` finds them, both ways, each
/// branch once however many of the solutions it holds. Each gets a `user` point at the value.
std::vector<Branch> trace_through(const Problem& problem, const std::vector<Guess>& solutions,
                                  const TraceOptions& options, const Observer& observer = {});

}  // namespace arcslip::continuation
