#pragma once

// The curves on a triangulated surface along which a function vanishes, and on them the zeros of others.

#include <functional>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "arcslip/continuation/atlas/triangulation.hpp"

namespace arcslip::continuation {

/// Of a curve.
struct ZeroPoint {
  Vector at;                 ///< N
  const Disc* disc;          ///< in whose plane it was found
  bool is_crossing = false;  ///< of sheets: the rest is not known then
  Vector tests = {};         ///< functions along the curve whose zeros are special points
  Vector sense = {};         ///< all of these may have the other sign: with this one, unless it is empty
  int zero = -1;             ///< which of the tests vanishes; -1 if none does
};

/// What vanishes.
class SurfaceFunction {
 public:
  virtual ~SurfaceFunction() = default;

  /// At a point with its tangent plane, where the surface was evaluated last.
  virtual double value(const Vector& at, const Matrix& plane) = 0;

  /// Whether what vanishes on an edge in which sheets cross is taken to do so where they cross.
  virtual bool vanishes_at_crossings() const { return false; }

  /// Sets `tests` and `sense` of a zero, with its tangent plane; false where they have no value.
  [[nodiscard]] virtual bool look(const Matrix& /*plane*/, ZeroPoint& /*point*/) { return true; }
};

/// Serves one thread. All is kept by reference.
class ZeroCurves {
 public:
  using Edge = std::pair<int, int>;  ///< of discs, the lower number first
  using Curve = std::vector<ZeroPoint>;

  ZeroCurves(const Problem& problem, Surface& surface, Covering& covering, const Triangulation& triangles);

  /// Signs of a function of size 1 at each disc, so that where it vanishes on discs they differ from others':
  /// on the box's sides from those beside them.
  std::vector<bool> signs(const std::vector<double>& values) const;

  /// A point on each of these edges, at whose ends the function differs in sign, solved for on the surface,
  /// in their order along the curves, with the zeros of tests between them. Closed curves end where they
  /// begin.
  std::vector<Curve> find(SurfaceFunction& function, const std::function<bool(const Edge&)>& has_zero);

  /// Whether the orientation differs between an edge's ends, as where another sheet crosses.
  bool turns_over(const Edge& edge) const { return differs(orientations_, edge); }

  /// Whether something that each disc has differs between an edge's ends.
  static bool differs(const std::vector<bool>& of_discs, const Edge& edge) {
    return of_discs[static_cast<std::size_t>(edge.first)] != of_discs[static_cast<std::size_t>(edge.second)];
  }

  bool has_failed() const { return has_failed_; }  ///< whether a point could not be solved for

 private:
  std::optional<ZeroPoint> between(SurfaceFunction& function, const Disc& disc, const Vector& a,
                                   const Vector& b, int sides);
  std::optional<ZeroPoint> crossing(const Disc& a, const Disc& b);
  std::optional<ZeroPoint> special(SurfaceFunction& function, const ZeroPoint& a, const ZeroPoint& b,
                                   Index test);
  Curve follow(SurfaceFunction& function, const std::map<Edge, std::vector<Edge>>& beside, Edge edge,
               std::map<Edge, bool>& passed);
  Curve with_specials(SurfaceFunction& function, Curve points);

  const Problem& problem_;
  Surface& surface_;
  Covering& covering_;
  const Triangulation& triangles_;
  std::vector<bool> orientations_;  // of the discs: whether they are positive
  Matrix plane_;
  bool has_failed_ = false;
};

}  // namespace arcslip::continuation
