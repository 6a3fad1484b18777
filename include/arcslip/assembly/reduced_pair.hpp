#pragma once

// The matrices behind a FrictionSystem, in fifty digits.

#include "arcslip/assembly/system.hpp"
#include "arcslip/structure/sector.hpp"

namespace arcslip {

/// Reduced base and damper of `parameters`, before they are turned into modes.
struct ReducedPair {
  ReducedStructure base;    ///< with the load
  ReducedStructure damper;  ///< without load
};

/// Of rods and beams.
ReducedPair reduce(const SystemParameters& parameters);

}  // namespace arcslip
