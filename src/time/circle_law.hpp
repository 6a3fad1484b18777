#pragma once

#include "arcslip/elements/pressed/pressed_contact.hpp"
#include "arcslip/time/ring_law.hpp"

namespace arcslip {

/// A friction circle in time: the slider's place z, along x and along y, is what it remembers. It slips up to
/// where it is about to come apart and from just behind where the parts have touched: nearer by, for 1e-8 of
/// the ring's shortest time, the direction of the slip changes without bound and its force is left out.
std::unique_ptr<const RingLaw> circle_law(const PressedSettings& settings);

}  // namespace arcslip
