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
};

}  // namespace arcslip
