#pragma once

// What a contact under a varying normal force tells of a period beside its forces.

#include <array>

#include "arcslip/elements/pressed/pressed_contact.hpp"
#include "arcslip/motion/odd_motion.hpp"

namespace arcslip {

/// A number that follows from the motion.
struct ContactNumber {
  double value = 0;                                    ///< itself
  ComplexVector by_motion;                             ///< by Re and Im of x_h as real and imaginary part
  std::array<double, PressedForce::settings> by = {};  ///< by each setting
};

/// Such numbers.
struct ContactReadings {
  ContactNumber greatest_traction;  ///< max |T|; where several are as great the mean of their derivatives
  ContactNumber slip_fraction;      ///< of the period
  ContactNumber apart_fraction;     ///< of the period
};

}  // namespace arcslip
