#pragma once

// A branch as a continuous curve: between two neighbouring points the cubic with their values and tangents,
// in the arclength s [Hermite],
//
//   z(x) = z_0 y^2 (1 + 2x) + z_1 x^2 (1 + 2y) + h (t_0 x y^2 - t_1 x^2 y),   x = (s - s_0)/h,  y = 1 - x,
//
// whose error is z''''/384 h^4 at most.

#include <vector>

#include "arcslip/continuation/branch.hpp"

namespace arcslip::continuation {

/// A place on the curve between the points of a branch.
struct Sample {
  Vector unknowns;       ///< n
  Vector parameters;     ///< all
  double arclength = 0;  ///< as in the branch
  int regime = 0;
  Vector error;  ///< n + 1: estimated absolute error of (u, p_a), from the change of z''' between neighbours
};

/// Keeps a reference to the branch, which must have two points at least.
class InterpolatedBranch {
 public:
  /// `parameter` is the position of the continuation parameter among the problem's.
  InterpolatedBranch(const Branch& branch, Index parameter);

  double begin() const { return branch_.points.front().arclength; }
  double end() const { return branch_.points.back().arclength; }

  /// At an arclength between begin() and end(); throws std::out_of_range elsewhere.
  Sample at(double arclength) const;

  /// Wherever the continuation parameter has this value, in the order of the branch.
  std::vector<Sample> where(double value) const;

  /// `count` samples at equal distances from begin() to end(); at least two.
  std::vector<Sample> resample(std::size_t count) const;

 private:
  Vector position(std::size_t point) const;
  const Vector& leaving(std::size_t piece) const;
  const Vector& arriving(std::size_t piece) const;
  double length(std::size_t piece) const;
  Vector third_derivative(std::size_t piece) const;
  bool smooth_between(std::size_t piece) const;
  Vector fourth_derivative(std::size_t piece) const;
  Sample sample(std::size_t piece, double x) const;

  const Branch& branch_;
  Index parameter_;
};

}  // namespace arcslip::continuation
