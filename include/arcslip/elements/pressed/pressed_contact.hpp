#pragma once

// Elastic Coulomb friction under a normal force that varies: a spring k_t in series with a slider that yields
// at mu N, N = max(0, N_0 + k_n g), where the parts may come apart and touch again. Over the arcs of
// pressed_arcs.hpp both forces are trigonometric polynomials,
//
//   stick: f = k_t r - A,   slip: f = +-mu N,   apart: f = N = 0,
//
// so that their harmonics are closed integrals. Both forces are continuous, so that moving ends of arcs do
// not count in the derivatives; A moves as k_t r -+ mu n does at the angle where slip ended, and where the
// parts have touched as k_t (r + (r'/n') (-n)).
//
// Harmonics are those of x = x_0 + Re sum_h x_h e^{jh theta}; those of the force and its derivatives,
//
//   delta f_h = sum_m linear(h, m) delta x_m + conjugate(h, m) conj(delta x_m),
//
// have for m = 0 half of the derivative each. At transitions derivatives are those of the side on which the
// arcs were found. All is to the rounding of k_t r and N.

#include <array>
#include <span>

#include "arcslip/elements/pressed/pressed_arcs.hpp"

namespace arcslip {

/// Derivatives of the harmonics of a force by those of a motion.
struct HarmonicDerivative {
  ComplexMatrix linear;     ///< harmonics x harmonics
  ComplexMatrix conjugate;  ///< the same
};

/// What such a contact does with its forces.
struct PressedForce {
  /// A setting that forces have derivatives by, as an index.
  enum Setting { friction, tangential_stiffness, normal_stiffness, normal_force, settings };

  ComplexVector tangential;                           ///< f_h, against r
  ComplexVector normal;                               ///< N_h, pressing
  HarmonicDerivative tangential_by_sliding;           ///< by r
  HarmonicDerivative tangential_by_closing;           ///< by g
  HarmonicDerivative normal_by_closing;               ///< by g; N does not depend on r
  std::array<ComplexVector, settings> tangential_by;  ///< of f_h by each setting
  std::array<ComplexVector, settings> normal_by;      ///< of N_h by each setting

  double energy = 0;             ///< lost per cycle
  double slip_fraction = 0;      ///< of the period
  double apart_fraction = 0;     ///< of the period
  FurtherSlips further_slips{};  ///< where it does not drift
};

/// The sliding motion of these coefficients, in the course that drifts with its drift.
PeriodicMotion sliding_motion(std::span<const int> orders, const ComplexVector& sliding,
                              PressedArcs::Course course);

/// The settled forces under the motions with these `orders` (h >= 0, different ones), one coefficient each;
/// the derivatives only if they are wanted. In the course that drifts, 0 is among the orders and its sliding
/// coefficient has the drift as imaginary part. Throws std::invalid_argument of settings out of their range
/// or orders that do not fit.
PressedForce pressed_force(const PressedSettings& settings, std::span<const int> orders,
                           const ComplexVector& sliding, const ComplexVector& closing, bool derivatives,
                           PressedArcs::Course course = PressedArcs::Course::any);

/// The same over these arcs, which are those of a course or near them.
PressedForce pressed_force(const PressedSettings& settings, std::span<const int> orders,
                           const ComplexVector& sliding, const ComplexVector& closing, bool derivatives,
                           std::span<const PressedArcs::Arc> arcs, PressedArcs::Course course);

}  // namespace arcslip
