#pragma once

// The velocity of a periodic motion that no load drives, a disturbance which lasts: its phase is free.

#include <span>

#include "arcslip/time/ring_waves.hpp"
#include "arcslip/time/stick_pattern.hpp"

namespace arcslip {

/// Whether the motion of these elements is one.
inline bool is_free(std::span<const StickPattern> elements) {
  return !elements.empty() && !elements.front().free_force.empty();
}

/// Harmonic h, of which those below zero are the conjugates, of a mode's velocity over eta, jh p_h.
inline Complex own_velocity(const Oscillator& mode, int h, double eta,
                            std::span<const StickPattern> elements) {
  const double turns = h * eta;
  Complex force = 0;
  Index i = 0;
  for (const StickPattern& element : elements) {
    for (const ComplexVector& all : element.free_force) {
      const Complex part = std::conj(mode.shape(i++));
      if (std::abs(h) < all.size()) force += part * (h < 0 ? std::conj(all(-h)) : all(h));
    }
  }
  if (h == 0 || force == 0.0) return 0;
  const Complex rate = mode.stiffness() + Complex(-turns * turns, turns * mode.damping);
  return -Complex(0, h) * force / rate;
}

}  // namespace arcslip
