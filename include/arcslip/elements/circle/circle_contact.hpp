#pragma once

// Elastic Coulomb friction in a plane under a normal force that varies: the friction circle,
//
//   T = k_t (r - z),   |T| <= mu N,   N = max(0, N_0 + k_n g),
//
// with r = x + i y the sliding displacement, written as a complex number of the plane, z the slider's place
// and g the closing displacement. In slip T = mu N e^{i phi}, the slider moves along the force, and
//
//   phi' = k_t/(mu N) Im(r' e^{-i phi}).
//
// Harmonics are those of x = x_0 + Re sum_h x_h e^{jh theta} of each direction. What the contact does is
// found arc by arc without sampling, see src/elements/circle: forces to some 1e-12 of k_t r and mu N,
// derivatives to some 1e-10; within 1e-10 of the border of stick forces to some 1e-6, derivatives to 1e-5.

#include <array>
#include <span>

#include "arcslip/elements/disturbed_law.hpp"
#include "arcslip/elements/pressed/pressed_contact.hpp"

namespace arcslip {

/// What such a contact does. Vectors hold all harmonics of the force along x, then those along y, then those
/// of N.
struct CircleForce {
  ComplexVector harmonics;                               ///< against x and y, and pressing
  ComplexMatrix linear;                                  ///< derivatives as in `ElementForce`
  ComplexMatrix conjugate;                               ///< the same
  std::array<ComplexVector, PressedForce::settings> by;  ///< of the harmonics by each setting

  double energy = 0;             ///< lost per cycle, in both directions
  double slip_fraction = 0;      ///< of the period
  double apart_fraction = 0;     ///< of the period
  FurtherSlips further_slips{};  ///< begun on either side of a line
};

/// The settled forces under the motion with these `orders` (h >= 0, different ones): x, y and g one behind
/// the other, without g where the normal force is constant; derivatives only if they are wanted. On the side
/// `sticks` of the border N is n = N_0 + k_n g, and the slider rests at r = 0 or, where it cannot, on the way
/// there from the most central place that holds it; `slips` goes on beyond the border in proportion. A force
/// that does not settle is not a number. Throws std::invalid_argument of settings out of their range, mu = 0
/// among them, or orders that do not fit.
CircleForce circle_force(const PressedSettings& settings, std::span<const int> orders,
                         const ComplexVector& motion, bool derivatives, PressedArcs::Course course);

/// What small disturbances of the motion meet over `turn`, pi of a force that is odd or 2 pi.
DisturbedLaw circle_law(const PressedSettings& settings, std::span<const int> orders,
                        const ComplexVector& motion, bool slips, double turn);

/// By how much all mu N would have to be greater for the contact to stick for ever: min over z of max over
/// theta of |k_t (r - z)| - mu n.
struct CircleRoom {
  double excess;                                  ///< that; negative where it sticks
  ComplexVector by_motion;                        ///< by Re and Im of x_h as real and imaginary part
  std::array<double, PressedForce::settings> by;  ///< by each setting
};
CircleRoom circle_room(const PressedSettings& settings, std::span<const int> orders,
                       const ComplexVector& motion);

}  // namespace arcslip
