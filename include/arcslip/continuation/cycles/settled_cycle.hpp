#pragma once

// A stable cycle, found as what a motion settles on.

#include "arcslip/continuation/cycles/cycle_branch.hpp"

namespace arcslip::continuation {

/// Follows the flow from `u` for a time, by default fifty periods of the field's own, then looks for a cycle
/// over as much time again: of a field that depends on time, one of its own period; else where the motion
/// comes back to a plane across it as near as `close` of how far it goes. Of the rounds after which it does
/// the first counts beside which Newton's method finds a stable cycle, or one that the motion is on; where
/// there is none the motion is followed further, a few times as long. The start is that cycle. Throws
/// std::invalid_argument that says why there is none.
CycleStart settled_cycle(const std::shared_ptr<const Field>& field, const Vector& u, const Vector& p,
                         std::optional<double> time, const CycleOptions& options = {},
                         const std::function<bool()>& go_on = {});

}  // namespace arcslip::continuation
