#pragma once

// The settled loop of a Jenkins element, a unit spring in series with a slider that yields at S, driven by a
// motion r(theta) of odd harmonics whose amplitude is above S:
//
//   f(theta) = s S + r(theta) - r(begin)   on an arc of stick that begins where the motion turns back, with
//                                          the force s S of the slip before it
//   f(theta) = s S                         on the arc of slip that follows
//
// With the arcs known, the harmonics of the force are closed integrals over those of stick, for f' = r' there
// and 0 elsewhere:
//
//   f_h = (2/(jh pi)) sum_arcs int r'(theta) e^{-jh theta} dtheta.
//
// The force is continuous, so that moving ends of arcs do not count in its derivative:
//
//   delta f_h = (2/pi) sum_arcs int (delta r(theta) - delta r(begin)) e^{-jh theta} dtheta
//             = sum_l G_hl delta r_l + Q_hl conj(delta r_l).
//
// With one harmonic f_1 = phi(R/S) r_1 of contact.hpp.
//
// An arc of stick from b to e, before which the force is g S and behind which it is n S, begins elsewhere as
// the motion changes, by -delta r'(b)/r"(b), and slip begins elsewhere, by -D/r'(e), D = delta r(e) - delta
// r(b) + (g - n) delta S. Two changes, 1 and 2, together change f_h by
//
//   (2/pi) sum_arcs [ delta_1 r'(b) delta_2 r'(b)/r"(b) int e^{-jh theta} dtheta - D_1 D_2 e^{-jhe}/r'(e) ],
//
// the last term only where slip follows. It is one-sided where the number of slips changes.

#include "arcslip/elements/slip_count.hpp"
#include "arcslip/motion/swing.hpp"

namespace arcslip {

/// The settled loop of one motion.
class HysteresisLoop {
 public:
  /// The loop settles within half a period from the motion's maximum, where the force is S. Just below the
  /// amplitude S, where a corrector may step before it is sent back, it is continued by
  /// f = r -+ (amplitude - S). `motion` must outlive the loop and not be zero.
  HysteresisLoop(const OddMotion& motion, double slip_threshold);

  Swing swing() const { return Swing::of_odd({begin_, amplitude_}); }  ///< of the motion

  /// f_h, in the units of r.
  void force(HarmonicVector& harmonics) const;

  /// G and Q. The derivative in S follows by homogeneity: df_h/dS = (f_h - (G r + Q conj(r))_h)/S.
  void derivative(ComplexMatrix& linear, ComplexMatrix& conjugate) const;

  /// How G and Q change with r and S: the derivatives along `motion` (of the same harmonics) and `threshold`.
  void second(const HarmonicVector& motion, double threshold, ComplexMatrix& linear,
              ComplexMatrix& conjugate) const;

  /// Energy lost per cycle over k: 2 S times the distance slipped in half a period.
  double energy() const { return 2 * slip_threshold_ * slipped_; }

  int slips() const { return slips_; }  ///< arcs of slip in half a period

  /// Told of half a period.
  FurtherSlips further_slips() const {
    return FurtherSlips::of({further_, SlipCount()}, slip_threshold_, further_.count() > 1);
  }

  /// An arc of stick, in theta.
  struct Arc {
    double begin;       ///< theta
    double width;       ///< of theta
    double before = 1;  ///< force over S where it begins
    double behind = 0;  ///< the same where it ends in slip; 0 where it goes on as the next half period begins
  };

  /// Those of half a period.
  std::span<const Arc> stick() const { return {stick_.data(), sticks_}; }

 private:
  void march();
  static double way_to_slip(const OddMotion::Departure& departure, double longest, double room);

  const OddMotion& motion_;
  double slip_threshold_;
  double amplitude_ = 0;
  double begin_ = 0;     // angle of the maximum
  double mismatch_ = 0;  // f half a period later, plus S: 0 but for the continuation
  double slipped_ = 0;
  int slips_ = 0;
  SlipCount further_;
  std::array<Arc, std::size_t{2} * most_harmonics> stick_;
  std::size_t sticks_ = 0;
};

}  // namespace arcslip
