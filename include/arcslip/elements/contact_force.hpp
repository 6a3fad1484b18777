#pragma once

// The force k f(r) of one contact, a spring with a slider, in several odd harmonics, with its derivatives.

#include <span>

#include "arcslip/motion/odd_motion.hpp"

namespace arcslip {

struct ContactForce {
  HarmonicVector harmonics;         ///< k f_h
  HarmonicVector by_log_threshold;  ///< k df_h/d ln S
  ComplexMatrix linear;             ///< k G of hysteresis_loop.hpp
  ComplexMatrix conjugate;          ///< k Q
  double energy = 0;                ///< lost per cycle over k S^2
  OddMotion::Maximum maximum{};     ///< of the motion, in slip

  /// The force under the motion r with these orders: k r in stick, that of HysteresisLoop in slip. All but
  /// the harmonics and the energy only with `derivatives`. Allocates nothing where the sizes are those of
  /// before.
  void set(std::span<const int> orders, const HarmonicVector& r, double stiffness, double threshold,
           bool slips, bool derivatives);

  /// How the harmonics and their derivatives, as they were last set with these arguments, change with r and
  /// with ln S. Of the energy and the maximum nothing is said.
  ContactForce change(std::span<const int> orders, const HarmonicVector& r, double stiffness,
                      double threshold, bool slips, const HarmonicVector& motion, double log_threshold) const;

  /// Adds so much of a change.
  void add(const ContactForce& change, double part);
};

}  // namespace arcslip
