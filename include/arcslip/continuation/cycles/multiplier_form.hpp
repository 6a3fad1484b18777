#pragma once

// Which way what leaves a cycle or a fixed point of a map goes where multipliers cross the unit circle: from
// one round to the next, with w along the critical vector v,
//
//   period doubling   w -> -(w + c w^3)
//   Neimark-Sacker    w -> mu (w + d w |w|^2), mu = e^(j theta)
//   fold              w -> w + b w^2
//
// Of cycles these are divided by T, so that they are those of w' = c w^3, w' = j theta/T w + d w |w|^2 and w'
// = b w^2 with int_0^T |v|^2 dt = 1 [Yu. A. Kuznetsov, W. Govaerts, E. J. Doedel, A. Dhooge, SIAM J. Numer.
// Anal. 43 (2005) 1407], v of a fold without a part along the cycle's velocity; of maps |v| = 1. Where c or
// Re d is below 0 what leaves is stable in the plane of v, and the point is supercritical.
//
// They follow from the equations that hold the cycle, F(u) = 0: with v(T) = mu v(0) in place of v(T) = v(0)
// their Jacobian is K(mu), and u + sum_a h_a w^a solves them order by order, K(mu^a) h_a = -r_a, r_a read
// from series of F along curves. T changes with |w|^2.

#include <cmath>
#include <limits>
#include <optional>

#include "arcslip/continuation/cycles/cycle_problem.hpp"
#include "arcslip/continuation/points/point_type.hpp"
#include "arcslip/continuation/problem/guess.hpp"
#include "arcslip/continuation/problem/problem.hpp"

namespace arcslip::continuation {

struct MultiplierForm {
  double coefficient = 0;  ///< c, Re d, or |b|, whose sign is that of v
  double error = 0;        ///< estimated; 0 where derivatives are exact
  double terms = 0;        ///< the sum of the sizes of what makes up c or d, and what is usual
  double rounding = 0;     ///< of the coefficient: terms cancel where mu^3 is nearly 1

  /// The coefficient over its terms; 0 where it is no more than its error may be, as all along a curve of
  /// what is linear, and nan where that is as much as the terms, as at mu^3 = 1: a function that there were 0
  /// would begin with a jump.
  double relative() const {
    constexpr double surely = 10;
    const double unknown = surely * (error + rounding);
    if (!(unknown < terms)) return std::numeric_limits<double>::quiet_NaN();
    return std::abs(coefficient) > unknown ? coefficient / terms : 0;
  }
};

/// Whether one of the multipliers, by their logarithms, is where that of a period doubling, a Neimark-Sacker
/// point or a fold is. Where a parameter tells orbits apart by its last digits alone, as along canards,
/// multipliers pass there by decades from one number to the next: the parameter is known then, the orbit is
/// not.
[[nodiscard]] bool has_critical_multiplier(PointType type, const ComplexVector& log_multipliers);

/// At a period doubling, a Neimark-Sacker point or a fold of a CycleProblem or a map. None where F cannot be
/// evaluated around it, where the orbit is not known, where mu^3 = 1, and where a torus has no angle. `angle`
/// is theta, where it is known; 0: that of the pair nearest to the unit circle.
[[nodiscard]] std::optional<MultiplierForm> multiplier_form(const Problem& problem, PointType type,
                                                            const Guess& at, double angle = 0);

/// How a torus leaves a cycle: v with v(1) = e^(j theta) v(0), n nodes, of any length.
struct TurningVector {
  ComplexVector vector;
  double angle = 0;  ///< theta, from 0 to pi
};

/// That of the pair of multipliers nearest to the unit circle; none without one. Of cycles on intervals.
[[nodiscard]] std::optional<TurningVector> turning_vector(const CycleProblem& cycles, const Guess& at);

}  // namespace arcslip::continuation
