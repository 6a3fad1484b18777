#pragma once

// The end of a regime within a step.

#include "arcslip/continuation/path/stepper.hpp"

namespace arcslip::continuation {

/// Where the branch crosses a border of its regime. A branch that comes beyond it by less than the tolerance,
/// as where it all but touches it, stays inside.
Zero border_crossing(Stepper& stepper, Index border);

}  // namespace arcslip::continuation
