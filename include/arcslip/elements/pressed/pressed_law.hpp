#pragma once

// What small disturbances meet in a pressed contact (pressed_arcs.hpp), over a whole period:
//
//   stick       df = k_t dr - dA + 0,   dA = k_t dr + (dA/dn) k_n dg   where A was set
//   slip        df = sigma mu k_n dg
//   apart       df = 0
//
// and of the normal force dN = k_n dg where the parts touch. Friction is continuous where an arc ends, and
// slip ends as it stands still, so that ends that move add nothing but dA/dn = -k_t r'/n' at re-contact.

#include "arcslip/elements/disturbed_law.hpp"
#include "arcslip/elements/pressed/pressed_arcs.hpp"

namespace arcslip {

/// Of the sliding and the closing coordinate, or of the former alone, `coordinates` = 1.
DisturbedLaw pressed_law(const PressedSettings& settings, const PressedArcs& course, Index coordinates);

}  // namespace arcslip
