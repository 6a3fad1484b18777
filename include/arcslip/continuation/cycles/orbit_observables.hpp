#pragma once

// What is told of orbits: the largest and the smallest value of each unknown, `x_max` and `x_min`, and
// `norm`, the root of the mean of |u|^2 over the orbit.

#include "arcslip/continuation/cycles/orbit_problem.hpp"

namespace arcslip::continuation {

/// What the duration is called among them: `T`, or `period` beside an unknown or a parameter T.
std::string duration_name(const std::vector<std::string>& unknowns,
                          const std::vector<std::string>& parameters);

/// Those of the unknowns that the problem tells, in the order above.
std::vector<Observable> orbit_observables(const OrbitProblem& problem);

/// Their values.
Vector observed_on_orbit(const OrbitProblem& problem, const Vector& u, const Regime& regime);

/// That of one of them, and its derivatives by u, which come as zeros; where on the orbit an extremum lies
/// tells its piece.
double observed_on_orbit(const OrbitProblem& problem, const Vector& u, const Regime& regime, Index which,
                         Gradient& gradient);

/// How many of these there are on an orbit: its parts, which begin off the places that phases hold.
constexpr Index orbit_pieces = 16;

}  // namespace arcslip::continuation
