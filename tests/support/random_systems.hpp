#pragma once

// Passive systems drawn at random, over the decades that the parameters may have.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <utility>

#include "arcslip/assembly/system.hpp"

namespace arcslip::testing {

/// From below to above all resonances of the first pair of modes, in eta.
inline std::pair<double, double> resonance_range(const SystemParameters& s) {
  const auto n = static_cast<double>(s.wave_number);
  const bool rods = s.model == StructureModel::rods;
  const double damper = rods ? n : n * n;
  const double base = damper * s.frequency_ratio;
  const double stuck = std::sqrt(s.interface_stiffness * (1 + 1 / s.mass_ratio)) / (rods ? 6.28 : 39.5);
  return {0.2 * std::min(base, damper), 5 * std::max({base, damper, stuck})};
}

/// The same systems for the same seed everywhere: std::uniform_real_distribution differs from library to
/// library.
class RandomSystems {
 public:
  explicit RandomSystems(std::uint64_t seed) : engine_(seed) {}

  double uniform(double low, double high) {
    return low + (high - low) * static_cast<double>(engine_() >> 11) * 0x1p-53;
  }
  double log_uniform(double low, double high) { return std::exp(uniform(std::log(low), std::log(high))); }
  Index integer(Index low, Index high) {
    return low + static_cast<Index>(engine_() % static_cast<std::uint64_t>(high - low + 1));
  }

  /// Rods or beams with enough elements for their wave; all else is left.
  SystemParameters ring(Index most_waves, Index most_elements) {
    SystemParameters s;
    s.model = integer(0, 1) == 0 ? StructureModel::rods : StructureModel::beams;
    s.wave_number = integer(1, most_waves);
    s.elements = integer(2 * s.wave_number + 1, most_elements);
    return s;
  }

  SystemParameters system() {
    SystemParameters s = ring(5, 200);
    s.mass_ratio = log_uniform(0.2, 200);
    s.frequency_ratio = log_uniform(0.3, 8);
    s.interface_stiffness = log_uniform(1e-2, 1e7);
    s.base_damping = log_uniform(1e-6, 0.1);
    s.damper_damping = log_uniform(1e-6, 0.1);
    s.preload = log_uniform(1e-6, 1e6);
    return s;
  }

 private:
  std::mt19937_64 engine_;
};

}  // namespace arcslip::testing
