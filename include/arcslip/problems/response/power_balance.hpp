#pragma once

// Where the energy of a periodic response goes, per cycle and sector:
//
//   pi Im(F^H d_1)* = sum_h pi h d_h^H Im Z_h d_h  over base and damper  +  friction
//
// in modal coordinates, or with all dofs of a sector that is solved for. The left side needs the motion of
// the load alone, friction the arcs of slip in time, so that their agreement proves a solution by other means
// than it was found.

#include "arcslip/problems/response/harmonic_response.hpp"

namespace arcslip::problems {

/// Energies of a cycle of one sector.
struct PowerBalance {
  double input;     ///< work of the excitation
  double base;      ///< lost in the base's damping, negative where that feeds energy in
  double damper;    ///< lost in the damper's
  double friction;  ///< lost in all contacts

  double magnitude;  ///< of all forces times the motions they act on, whatever their phase

  /// |input - losses| over `magnitude`: how far phases are from those of the solution, in radians.
  double error() const;
  /// `magnitude` over the largest of input and losses: by so much rounding and the tolerance grow in these,
  /// which are small against forces times motions where damping is light.
  double cancellation() const;
};

/// At a solution.
PowerBalance power_balance(const HarmonicResponse& problem, const Vector& u, const Vector& p,
                           const continuation::Regime& regime);

/// The largest |u - y - r| of any contact and harmonic, y of the base's equation alone and u of the damper's,
/// over the largest of |y|, |u| and |r|.
double motion_error(const HarmonicResponse& problem, const Vector& u, const Vector& p,
                    const continuation::Regime& regime);

}  // namespace arcslip::problems
