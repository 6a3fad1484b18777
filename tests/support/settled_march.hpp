#pragma once

// Brute force for motions in time: masses with sliders that move between steps of the classical Runge-Kutta
// method for accelerations.

#include "arcslip/types.hpp"

namespace arcslip::testing {

/// The first harmonic of d'' = acceleration(d, d', t) under a load of eta periods in a unit of time, in the
/// last of 200 periods from rest. `settle(d)` is called behind each of the steps of a period.
template <class Acceleration, class Settle>
ComplexVector settled_march(Index size, double eta, int steps, const Acceleration& acceleration,
                            const Settle& settle) {
  constexpr int periods = 200;
  const double w = 2 * std::numbers::pi * eta;
  const double dt = 1 / (eta * steps);
  Vector d = Vector::Zero(size);
  Vector v = d;
  ComplexVector harmonic = ComplexVector::Zero(size);
  for (int step = 0; step < steps * periods; ++step) {
    const double t = dt * step;
    if (step >= steps * (periods - 1))
      harmonic += (2.0 / steps) * std::polar(1.0, -w * t) * d.cast<Complex>();
    const Vector a1 = acceleration(d, v, t);
    const Vector a2 = acceleration(d + dt / 2 * v, v + dt / 2 * a1, t + dt / 2);
    const Vector a3 = acceleration(d + dt / 2 * v + dt * dt / 4 * a1, v + dt / 2 * a2, t + dt / 2);
    const Vector a4 = acceleration(d + dt * v + dt * dt / 2 * a2, v + dt * a3, t + dt);
    d += dt * v + dt * dt / 6 * (a1 + a2 + a3);
    v += dt / 6 * (a1 + 2 * a2 + 2 * a3 + a4);
    settle(d);
  }
  return harmonic;
}

}  // namespace arcslip::testing
