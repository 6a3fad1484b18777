#pragma once

// A branch as a continuous curve: between two neighbouring points a polynomial with their values, the
// directions of their tangents, and those of the nearest point on either side [Hermite]. It is a graph over a
// line,
//
//   z(s),   s = n . (z - z_0),   n . (z_1 - z_0) = 1,   dz/ds = t/(n . t) at each of the points,
//
// whose error is of eighth order where there are points on both sides. The line is the parameter's, that of
// the unknowns, or the axis of the parabola that the piece is most like, whichever the terms fall off best
// on; so needle-sharp peaks and folds are met alike. Beside a corner it is a polynomial in the root of the
// distance from it, where terms fall off better so: from a border across which F has a root in it.

#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "arcslip/continuation/path/branch.hpp"
#include "arcslip/continuation/path/corrector.hpp"

namespace arcslip::continuation {

/// A place on the curve between the points of a branch.
struct Sample {
  Vector unknowns;       ///< n
  Vector parameters;     ///< all
  double arclength = 0;  ///< as in the branch
  Regime regime;         ///< of the piece
  Vector error;          ///< n + 1: estimated absolute error of (u, p_a), from the points around the piece; 0
                         ///< where it was solved for
};

/// Keeps references to the branch, which must have two points at least, and to the problem. Not to be called
/// from several threads at once.
class InterpolatedBranch {
 public:
  /// `parameter` is the position of the continuation parameter among the problem's. With the problem, samples
  /// but for those of `place` are its solutions, to the tolerance, and only where none is found next to the
  /// curve the curve's.
  InterpolatedBranch(const Branch& branch, Index parameter, const Problem* problem = nullptr);
  ~InterpolatedBranch();

  /// The arclengths of the first point and of the last.
  double begin() const { return branch_.points.front().arclength; }
  double end() const { return branch_.points.back().arclength; }

  /// At an arclength between begin() and end(); throws std::out_of_range elsewhere.
  Sample at(double arclength) const;

  /// A part `x` of the way, from 0 to 1, between the points `piece` and `piece` + 1.
  Sample between(std::size_t piece, double x) const;

  /// The same without its error, which takes longer.
  Sample place(std::size_t piece, double x) const;

  /// The estimated error in the middle of a piece, relative to what changes along it.
  double doubt(std::size_t piece) const;

  /// Both for a curve with its problem: that place after one of Newton's corrections across the piece's
  /// chord, without its error, and as a point of the branch with its tangent, where there is a solution. None
  /// where that fails, or leads farther away than the piece is long.
  std::optional<Sample> corrected(std::size_t piece, double x) const;
  std::optional<BranchPoint> solution(std::size_t piece, double x) const;

  /// Wherever the continuation parameter has this value, in the order of the branch.
  std::vector<Sample> where(double value) const;

  /// `count` samples at equal distances from begin() to end(); at least two.
  std::vector<Sample> resample(std::size_t count) const;

 private:
  Vector position(std::size_t point) const;
  const Vector& leaving(std::size_t piece) const;
  const Vector& arriving(std::size_t piece) const;
  class Piece;
  double distance(std::size_t from, std::size_t to) const;
  bool is_corner(std::size_t point) const;
  std::vector<std::pair<std::size_t, bool>> around(std::size_t piece) const;
  std::optional<std::size_t> corner(std::size_t piece, int way) const;
  const Piece& curve(std::size_t piece) const;
  CurvePoint origin(const Sample& sample) const;
  void solve(Sample& sample, const Vector& along) const;
  template <class Correct>
  std::optional<CurvePoint> correct(const CurvePoint& origin, std::size_t piece, const Correct& by) const;
  Sample place(const Piece& curve, std::size_t piece, double x) const;

  const Branch& branch_;
  Index parameter_;
  std::unique_ptr<Corrector> corrector_;  // none without a problem
  mutable std::unique_ptr<Piece> last_;
};

}  // namespace arcslip::continuation
