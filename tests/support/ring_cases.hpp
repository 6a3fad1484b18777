#pragma once

// Small rings for tests of their motion in time.

#include <cmath>

#include "arcslip/elements/contact.hpp"
#include "arcslip/time/ring_motion.hpp"

namespace arcslip::testing {

/// Beams of few nodes that slip over most of a period at preload 1 and eta = 3.7.
inline SystemParameters small_beams(Index nodes = 6) {
  SystemParameters s;
  s.elements = nodes;
  s.mass_ratio = 5;
  s.frequency_ratio = 4;
  s.interface_stiffness = 2000;
  s.base_damping = 0.02;
  s.damper_damping = 0.05;
  return s;
}

/// Rods under a wave of two lengths round the ring; they slip at preload 0.1 and eta = 2.3.
inline SystemParameters small_rods(Index nodes = 7) {
  SystemParameters s;
  s.model = StructureModel::rods;
  s.wave_number = 2;
  s.elements = nodes;
  s.mass_ratio = 3;
  s.frequency_ratio = 1.5;
  s.interface_stiffness = 400;
  s.base_damping = 0.03;
  s.damper_damping = 0.1;
  return s;
}

/// A ring under its driving force.
struct RingCase {
  SystemParameters system;
  double eta;
  double preload;
};

/// The same with its damper fixed where no contact is.
inline SystemParameters held(SystemParameters s) {
  s.fixed_damper = true;
  return s;
}

inline SystemParameters driven(SystemParameters s, double base_damping) {
  s.base_damping = base_damping;
  return s;
}

/// Positions, velocities and memory in one vector.
inline Vector stacked(const RingState& state) {
  Vector all(2 * state.position.size() + state.memory.size());
  all << state.position, state.velocity, state.memory;
  return all;
}

/// r and the friction force of the one-harmonic response, by bisection of |r (1 + k phi c)| = |y_0|.
inline RingHarmonic one_harmonic(const SystemParameters& parameters, double eta, double preload) {
  const FrictionSystem system = build_system(parameters);
  const double k = system.contact_stiffness;
  const Complex compliance = system.base.at(eta).compliance + system.damper.at(eta).compliance;
  const Complex free = system.base.at(eta).free;
  const double threshold = system.slip_threshold(eta, preload);
  double low = -40;
  double high = 40;  // ln R
  for (int i = 0; i < 100; ++i) {
    const double middle = 0.5 * (low + high);
    const Complex phi = hysteresis_coefficient(std::exp(middle), threshold).phi;
    (std::exp(middle) * std::abs(1.0 + k * phi * compliance) > std::abs(free) ? high : low) = middle;
  }
  const Complex phi = hysteresis_coefficient(std::exp(low), threshold).phi;
  const Complex r = -free / (1.0 + k * phi * compliance);
  return {1, ComplexVector::Constant(1, r), ComplexVector::Constant(1, k * phi * r)};
}

/// S of the first contact.
inline double slip_threshold(const RingMotion& motion) {
  return motion.ring().elements.front().element->threshold(motion.load());
}

}  // namespace arcslip::testing
