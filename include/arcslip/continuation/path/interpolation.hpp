#pragma once

// A branch as a continuous curve: between two neighbouring points a cubic with their values and the
// directions of their tangents [Hermite],
//
//   z(x) = z_0 y^2 (1 + 2x) + z_1 x^2 (1 + 2y) + a_0 t_0 x y^2 - a_1 t_1 x^2 y,   0 <= x <= 1,  y = 1 - x,
//
// whose error is of fourth order. The lengths a_0, a_1 are those that make its third derivative least, each
// entry of z in its own size, so that parabolas are met, as folds and as peaks however needle-sharp, and such
// that the parameter does not turn.

#include <optional>
#include <vector>

#include "arcslip/continuation/path/branch.hpp"

namespace arcslip::continuation {

/// A place on the curve between the points of a branch.
struct Sample {
  Vector unknowns;       ///< n
  Vector parameters;     ///< all
  double arclength = 0;  ///< as in the branch
  Regime regime;         ///< of the piece
  Vector error;          ///< n + 1: estimated absolute error of (u, p_a), from the points around the piece
};

/// Keeps a reference to the branch, which must have two points at least.
class InterpolatedBranch {
 public:
  /// `parameter` is the position of the continuation parameter among the problem's.
  InterpolatedBranch(const Branch& branch, Index parameter);

  /// The arclengths of the first point and of the last.
  double begin() const { return branch_.points.front().arclength; }
  double end() const { return branch_.points.back().arclength; }

  /// At an arclength between begin() and end(); throws std::out_of_range elsewhere.
  Sample at(double arclength) const;

  /// A part `x` of the way, from 0 to 1, between the points `piece` and `piece` + 1.
  Sample between(std::size_t piece, double x) const;

  /// The same without its error, which takes longer.
  Sample place(std::size_t piece, double x) const;

  /// Wherever the continuation parameter has this value, in the order of the branch.
  std::vector<Sample> where(double value) const;

  /// `count` samples at equal distances from begin() to end(); at least two.
  std::vector<Sample> resample(std::size_t count) const;

 private:
  Vector position(std::size_t point) const;
  const Vector& leaving(std::size_t piece) const;
  const Vector& arriving(std::size_t piece) const;
  struct Cubic;
  double distance(std::size_t from, std::size_t to) const;
  Cubic cubic(std::size_t from, std::size_t to) const;
  bool is_corner(std::size_t point) const;
  std::optional<std::size_t> neighbour(std::size_t piece, int way) const;
  Vector missed(std::size_t from, std::size_t point, std::size_t to) const;
  Sample place(const Cubic& cubic, std::size_t piece, double x) const;
  Vector error(std::size_t piece, const Cubic& cubic) const;

  const Branch& branch_;
  Index parameter_;
};

}  // namespace arcslip::continuation
