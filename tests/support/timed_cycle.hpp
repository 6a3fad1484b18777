#pragma once

// Limit cycles in time: all nodes without load, as a balance begins them or to rounding, and what they make
// of disturbances.

#include <cmath>
#include <vector>

#include "arcslip/dense.hpp"
#include "arcslip/problems/response/floquet_response.hpp"
#include "arcslip/problems/tasks/verification.hpp"
#include "arcslip/time/ring_stability.hpp"

namespace arcslip::testing {

using problems::FloquetCycle;

/// The ring, and its state in a cycle.
struct TimedCycle {
  TimedCycle(const SystemParameters& system, const continuation::Guess& at)
      : ring(unloaded(system)),
        preload(at.parameters(FloquetCycle::preload)),
        motion(ring, at.unknowns(FloquetCycle::eta), preload) {
    const problems::HarmonicResponse response(build_harmonic_system(system));
    continuation::Guess same{at.unknowns, Vector(2), at.regime};
    same.unknowns.head<2>() << at.unknowns(FloquetCycle::amplitude), 0;
    same.parameters << at.unknowns(FloquetCycle::eta), preload;
    state = motion.travelling(problems::ring_harmonics(response, same));
  }

  /// Newton's method on G(s; eta) = s, whatever the phase. Returns |G(s) - s| over |s|, of positions.
  double settle(int rounds) {
    for (int round = 0; round < rounds; ++round) improve();
    const RingState next = next_state(motion, state);
    return (next.position - state.position).norm() / state.position.norm();
  }

  /// How fast what is left of a small disturbance after `first` periods grows in each of those that follow:
  /// how far the motion is from one that travels, whatever its phase.
  double growth(int first, int periods) {
    RingState moved = state;
    for (Index i = 0; i < moved.position.size(); ++i)
      moved.position(i) += 1e-4 * std::cos(1.0 + 2.0 * static_cast<double>(i)) * moved.position.norm();
    const auto distance = [&] {
      const RingState next = next_state(motion, moved);
      return (next.position - moved.position).norm() / moved.position.norm();
    };
    motion.advance(moved, first * motion.period());
    const double before = distance();
    motion.advance(moved, periods * motion.period());
    return std::pow(distance() / before, 1.0 / periods);
  }

  static Ring unloaded(const SystemParameters& system) {
    Ring ring = build_ring(system);
    ring.loads.clear();
    return ring;
  }
  static Vector stacked(const RingState& one) {
    Vector all(2 * one.position.size() + one.memory.size());
    all << one.position, one.velocity, one.memory;
    return all;
  }

  /// Memory that G gives a value of its own is no unknown.
  void improve() {
    constexpr double step = 1e-6;
    const StateDerivative here = next_derivative(motion, state);
    const Index n = state.position.size();
    const Index size = here.derivative.rows();
    const double eta = 1 / motion.period();
    const auto next_at = [&](double other) {
      RingMotion moved(ring, other, preload);
      return stacked(next_state(moved, state));
    };
    Matrix equations = Matrix::Zero(size + 1, size + 1);
    equations.topLeftCorner(size, size) = Matrix::Identity(size, size) - here.derivative;
    equations.col(size).head(size) = (next_at(eta * (1 - step)) - next_at(eta * (1 + step))) / (2 * step);
    equations.row(size).head(n) = state.velocity;
    Vector right = Vector::Zero(size + 1);
    right.head(size) = stacked(here.next) - stacked(state);
    for (Index i = 2 * n; i < size; ++i) {
      if (here.derivative.row(i).isZero(0)) right(i) = 0;
    }
    const Vector found = least_squares_of(equations, 1e-10)(right);
    state.position += found.head(n);
    state.velocity += found.segment(n, n);
    state.memory += found.segment(2 * n, size - 2 * n);
    motion = RingMotion(ring, eta * (1 + found(size)), preload);
  }

  Ring ring;
  double preload;
  RingMotion motion;
  RingState state;
};

/// mu of what changes by no more than a hundredfold in a period.
inline ComplexVector multipliers(const FloquetCycle& problem, const continuation::Guess& at) {
  std::vector<Complex> kept;
  for (const auto& one : problem.disturbances(at.unknowns, at.parameters, at.regime)) {
    const Complex mu = std::exp(two_pi / at.unknowns(FloquetCycle::eta) * one.exponent);
    if (std::abs(mu) > 1e-2) kept.push_back(one.is_negative ? -mu : mu);
  }
  return ComplexVector::Map(kept.data(), std::ssize(kept));
}

}  // namespace arcslip::testing
