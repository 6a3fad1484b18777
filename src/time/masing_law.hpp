#pragma once

#include "arcslip/elements/masing.hpp"
#include "arcslip/time/ring_law.hpp"

namespace arcslip {

/// Microslip in time: Masing's rules, with the places at which the motion has turned back as memory. The
/// backbone is held by polynomials of the fourth degree between its corners, to 1e-8 of its greatest force.
std::unique_ptr<const RingLaw> masing_law(const Backbone& backbone, double load);

}  // namespace arcslip
