#pragma once

// What a friction circle tells of a period beside its forces, with exact derivatives. With u along the force
// and v the rate of slip, ends of arcs move as the roots that they are:
//
//   onset of slip     |w - A| = b   d theta = -(u (dw - dA) - db)/(u w' - b')
//   end of slip       v = 0         d theta = -dv/v'
//   apart, touching   b = 0         d theta = -db/b'

#include "arcslip/elements/circle/circle_contact.hpp"

namespace arcslip {

/// A number that follows from the motion.
struct CircleNumber {
  double value = 0;                                    ///< itself
  ComplexVector by_motion;                             ///< by Re and Im of x_h as real and imaginary part
  std::array<double, PressedForce::settings> by = {};  ///< by each setting
};

/// Such numbers; not a number of what does not settle.
struct CircleReadings {
  CircleNumber greatest_traction;  ///< max |T|; where several are as great the mean of their derivatives
  CircleNumber slip_fraction;      ///< of the period
  CircleNumber apart_fraction;     ///< of the period
};

/// Under motions and on a side of the border as `circle_force` has them; zero derivatives unless they are
/// wanted.
CircleReadings circle_readings(const PressedSettings& settings, std::span<const int> orders,
                               const ComplexVector& motion, bool slips, bool derivatives);

}  // namespace arcslip
