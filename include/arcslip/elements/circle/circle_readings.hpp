#pragma once

// What a friction circle tells of a period beside its forces, with exact derivatives. With u along the force
// and v the rate of slip, ends of arcs move as the roots that they are:
//
//   onset of slip     |w - A| = b   d theta = -(u (dw - dA) - db)/(u w' - b')
//   end of slip       v = 0         d theta = -dv/v'
//   apart, touching   b = 0         d theta = -db/b'

#include "arcslip/elements/circle/circle_contact.hpp"
#include "arcslip/elements/pressed/contact_readings.hpp"

namespace arcslip {

/// Under motions and on a side of the border as `circle_force` has them; not a number of what does not
/// settle, zero derivatives unless they are wanted.
ContactReadings circle_readings(const PressedSettings& settings, std::span<const int> orders,
                                const ComplexVector& motion, bool slips, bool derivatives);

}  // namespace arcslip
