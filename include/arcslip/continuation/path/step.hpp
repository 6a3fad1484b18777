#pragma once

// A step along a branch within one regime as data: its ends, and what is known of the branch in between.

#include <optional>
#include <vector>

#include "arcslip/continuation/path/checkpoint.hpp"

namespace arcslip::continuation {

/// Over s = normal . (z - z_here)/scale, with the scale at `here`.
struct Step {
  CurvePoint here;            ///< where it begins
  CurvePoint there;           ///< its end once it is kept
  Hold hold = Hold::tangent;  ///< what the correction keeps
  Vector normal;              ///< n + 1: the condition that closes the equations
  double distance = 0;        ///< s at its end
  double tiny = 0;    ///< how short a step is on which what is unlike a curve is rounding, or a corner
  Vector slope_from;  ///< n + 1: d(z/scale)/ds where it begins, and
  Vector slope_to;    ///< where it ends
  Vector chord;       ///< n + 1: (z_there - z_here)/scale
  std::vector<Monitor> from;  ///< where it begins: of the tracked observables, then of the borders
  std::vector<Monitor> to;    ///< the same where it ends

  /// The first branch point within the step, if it passes one.
  struct Crossing {
    double s = 0;            ///< where in the step
    CurvePoint point;        ///< located to rounding
    Vector slope;            ///< n + 1, of the branch in s
    double rate_behind = 0;  ///< of the parameter
  };
  std::optional<Crossing> crossing;  ///< none where no branch point is passed

  /// A point of the branch within the step, relative to `here`.
  struct Anchor {
    double s;      ///< arclength from `here`
    Vector place;  ///< n + 1, in units of the scale
    Vector slope;  ///< d place/ds
  };
  std::vector<Anchor> anchors;  ///< by s
  std::vector<PastPoint> past;  ///< before `here`, the last one first
  double moved = 0;             ///< how far the parameter went in the step before, over its scale

  /// Arclength per s at its end, in the scale there.
  double arc_rate() const;

  /// Change of the parameter over s at both ends.
  double parameter_rate_from() const { return slope_from(slope_from.size() - 1); }
  double parameter_rate_to() const { return slope_to(slope_to.size() - 1); }

  /// Whether it is so short up to s.
  bool is_tiny(double s) const { return s * slope_from.norm() < tiny; }

  /// Where the parameter may turn twice within the step although it runs the same way at both ends.
  bool may_turn_twice() const;

  /// (z - z_here)/scale at s, by the cubic between the nearest points of the branch that are known.
  void interpolate(double s, Vector& out) const;
};

/// Change of the parameter over arclength at a point.
inline double parameter_rate(const CurvePoint& point) {
  const Index last = point.tangent.size() - 1;
  return point.tangent(last) * point.scale(last);
}

}  // namespace arcslip::continuation
