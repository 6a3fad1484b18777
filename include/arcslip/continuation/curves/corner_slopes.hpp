#pragma once

// The slopes of an observable on both sides of a border: along the branch over the active parameter as it
// arrives there in one regime and leaves in the one beyond. Where their signs differ the corner is an
// extremum.

#include <array>
#include <cmath>
#include <optional>

#include "arcslip/continuation/path/corrector.hpp"
#include "arcslip/continuation/points/extended_problem.hpp"

namespace arcslip::continuation {

/// The border that a point is nearest to among those of a regime but `except`, relative to the border's slope
/// in the problem's scale; none where it has no others.
struct NearestBorder {
  int border;       ///< its number in the regime; `distance` is to it
  double distance;  ///< >= 0 inside
};
[[nodiscard]] std::optional<NearestBorder> nearest_border(const Problem& base, Index active,
                                                          const BasePoint& point, const Regime& regime,
                                                          int except = -1);

/// The observable's slope over the active parameter on either side of a border, at points of it.
class CornerSlopes {
 public:
  /// The piece on which the branch comes to the border, and that on which it goes on.
  enum Side { arriving, leaving };

  /// `active` is the parameter's position, `observable` that of an observable with a gradient. The base is
  /// kept by reference.
  CornerSlopes(const Problem& base, Index active, Index observable);

  /// At a point on a border of its regime. False where nothing lies beyond the border or the branch has no
  /// tangent.
  [[nodiscard]] bool begin(const BasePoint& point, int border);

  /// Whether the pieces of both sides run along the border at a point of it, by its rate along them.
  bool touch(const BasePoint& point, double rate);

  /// d ln|Y|/ds on one side, with s in the base's scale; the tangents are those of the last call to `begin`
  /// or `follow` as they go on. nan where the base cannot be evaluated.
  double slope(const BasePoint& point, Side side);

  /// Takes the tangents at a point next to the last.
  void follow(const BasePoint& point);

  /// That of the piece, at the point last taken.
  const Regime& regime(Side side) const { return sides_[side].regime; }

  /// The slope a little way, in the base's scale, from a point on the border into the regime of a side.
  double slope_inside(const BasePoint& corner, Side side, double way);

  /// The first extremum inside the regime of a side, next to a point on the border and farther than `from`.
  [[nodiscard]] std::optional<BasePoint> extremum_inside(const BasePoint& corner, Side side, double from = 0);

  /// Where the slope times a sign is largest inside the regime of a side, up to a distance.
  struct Steepest {
    BasePoint point;  ///< inside the regime
    double slope;     ///< times 1 or -1
  };
  /// None where nothing can be evaluated inside.
  [[nodiscard]] std::optional<Steepest> steepest_inside(const BasePoint& corner, Side side, double sign,
                                                        double farthest);

 private:
  struct Branch {
    Regime regime;
    int border = 0;
    Vector tangent;  // n + 1, unit length in units of the scale, from `arriving` to `leaving`
  };

  std::optional<Regime> beyond(const BasePoint& point, int border);
  std::optional<int> way_back(const BasePoint& point, const Regime& beyond) const;
  bool set_tangent(const BasePoint& point, Branch& side);
  BasePoint just_beyond(const BasePoint& point, const Branch& side);
  double border_rate(const BasePoint& point, const Branch& side);
  [[nodiscard]] std::optional<BasePoint> inside(const BasePoint& corner, Side side, double way);

  const Problem& base_;
  Index active_;
  Index observable_;
  Corrector corrector_;
  CurvePoint at_;
  Gradient gradient_;
  std::array<Branch, 2> sides_;
};

}  // namespace arcslip::continuation
