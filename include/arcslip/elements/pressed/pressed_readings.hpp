#pragma once

// What a pressed contact tells of a period beside its forces, with exact derivatives: ends of arcs move, and
// the greatest force changes as that at its own theta, where it is a corner at an onset with this theta.

#include <span>

#include "arcslip/elements/pressed/contact_readings.hpp"

namespace arcslip {

/// Under motions and in a course as `pressed_force` has them; derivatives by r_h, then g_h, or zeros where
/// none are asked for.
ContactReadings pressed_readings(const PressedSettings& settings, std::span<const int> orders,
                                 const ComplexVector& sliding, const ComplexVector& closing,
                                 PressedArcs::Course course, bool derivatives);

}  // namespace arcslip
