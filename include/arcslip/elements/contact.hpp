#pragma once

// Bilinear hysteresis (Jenkins element) under harmonic motion of amplitude R, slip threshold S, first
// harmonic [paper (13)-(18), (30)]. With x = S/R and theta* = arccos(1 - 2x) the friction force is k phi r,
//
//   phi = 1                                                                   R <= S   (stick)
//   phi = (theta* - sin(2 theta*)/2)/pi + j (4/pi) x (1 - x)                  R >= S   (slip)
//
// phi depends on R/S alone, so d phi/dR = phi'/R and d phi/dS = -phi'/S, where phi' = d phi/d ln(R/S).

#include "arcslip/types.hpp"

namespace arcslip {

/// The contact law's first-harmonic coefficient and its derivative.
struct HarmonicCoefficient {
  Complex phi;      ///< 1 in stick
  Complex phi_log;  ///< d phi/d ln(R/S)
};

/// Slip, for ln(R/S) >= 0, to rounding for R/S from 1 to 1e12 and beyond. Just below zero, where a corrector
/// may step before it is sent back, it is continued by the polynomial of its imaginary part and by Re phi
/// = 1.
HarmonicCoefficient slip_coefficient(double log_ratio);

/// Either regime at R > 0, S > 0.
HarmonicCoefficient hysteresis_coefficient(double amplitude, double slip_threshold);

/// Energy lost per cycle over k S^2: 4 (R/S - 1) in slip, 0 in stick [Caughey 1960].
double dissipated_energy(double log_ratio);

/// The part of a period in slip, 1 - theta*/pi, and its derivative by ln(R/S); 0 in stick.
struct SlipFraction {
  double value;   ///< from 0 to 1
  double by_log;  ///< without bound at the border
};
SlipFraction slip_fraction(double log_ratio);

}  // namespace arcslip
