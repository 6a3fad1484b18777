#pragma once

// What a pressed contact tells of a period beside its forces, with exact derivatives. With the bounds B = k_t
// r
// - sigma mu n of its slider, sigma the direction of slip, ends of arcs move as the roots that they are:
//
//   onset of slip     B = A     d theta = -(dB - dA)/B'
//   end of slip       B' = 0    d theta = -dB'/B"
//   apart, touching   n = 0     d theta = -dn/n'
//
// The greatest force changes as that at its own theta, where it is a corner at an onset with this theta.

#include <array>
#include <span>

#include "arcslip/elements/pressed/pressed_contact.hpp"
#include "arcslip/motion/odd_motion.hpp"

namespace arcslip {

/// A number that follows from both motions.
struct PressedNumber {
  double value = 0;                                    ///< itself
  HarmonicVector by_sliding;                           ///< by Re r_h and Im r_h as real and imaginary part
  HarmonicVector by_closing;                           ///< by g_h
  std::array<double, PressedForce::settings> by = {};  ///< by each setting
};

/// Such numbers of a course.
struct PressedReadings {
  PressedNumber greatest_traction;  ///< max |f|; where several are as great the mean of their derivatives
  PressedNumber slip_fraction;      ///< of the period
  PressedNumber apart_fraction;     ///< of the period
};

/// Under motions and in a course as `pressed_force` has them.
PressedReadings pressed_readings(const PressedSettings& settings, std::span<const int> orders,
                                 const ComplexVector& sliding, const ComplexVector& closing,
                                 PressedArcs::Course course);

}  // namespace arcslip
