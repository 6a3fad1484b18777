#pragma once

// Where a sector resonates first under a travelling wave: K x = w^2 M x by inverse iteration, whose error
// falls with the square of the ratio of the two lowest w^2.

#include "arcslip/sectors/finite_sector.hpp"

namespace arcslip {

/// Lowest eta = w/(2 pi) with this wave number round `sectors` sectors, to about 1e-8; 0 where a motion of
/// the whole ring meets no stiffness. `sector` is checked.
double lowest_frequency(const FiniteSector& sector, Index wave_number, Index sectors);

/// Base and damper as one sector, each contact of one held to that of the other by a spring. Without load.
FiniteSector joined(const FiniteSector& base, const FiniteSector& damper, double contact_stiffness);

}  // namespace arcslip
