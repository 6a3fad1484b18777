#pragma once

// Regimes of m contacts, each of which sticks or slips: bit i of a regime says that contact i slips. A
// contact changes over where its amplitude A = max |r(t)| is S.

#include <string>
#include <vector>

#include "arcslip/motion/odd_motion.hpp"

namespace arcslip::problems {

inline std::size_t at(Index i) { return static_cast<std::size_t>(i); }

inline bool slips(int regime, Index contact) { return (regime >> contact & 1) != 0; }

/// "stick", "slip", or "slip 1 3" where only these contacts slip, for all regimes of `contacts`.
std::vector<std::string> slip_regimes(Index contacts);

/// (A^2 - S^2)/(A^2 + S^2) = tanh ln(A/S) in stick, its negative in slip, smooth where the motion is zero.
struct SlipBorder {
  double value;
  HarmonicVector by_motion;  ///< derivatives by Re r_h and Im r_h as real and imaginary part
  double by_log_threshold;   ///< d/d ln S
};

SlipBorder slip_border(const std::vector<int>& orders, const HarmonicVector& motion, double threshold,
                       bool slips);

/// Of a motion whose maximum is known.
SlipBorder slip_border(const std::vector<int>& orders, const OddMotion::Maximum& top, double threshold,
                       bool slips);

}  // namespace arcslip::problems
