#pragma once

// The solutions of F(u, p) = 0 over two parameters as a surface, covered by charts [Henderson 2002]: each
// is a disc in the tangent plane at a solution, so small that the surface hardly bends over it, and a polygon
// in it, what of the disc is nearer to this solution than to its neighbours'. Charts are added on the rim of
// others, wherever it lies in their polygons, until there is none: then the polygons cover the surface. The
// triangles of charts that meet at the polygons' corners triangulate it.

#include <array>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "arcslip/continuation/path/stop.hpp"
#include "arcslip/continuation/points/point_type.hpp"
#include "arcslip/continuation/problem/guess.hpp"
#include "arcslip/continuation/problem/problem.hpp"

namespace arcslip::continuation {

/// Both parameters, their ranges, and how fine the charts are.
struct AtlasOptions {
  std::array<std::string, 2> parameters;  ///< two different ones, by name
  std::array<double, 2> from{};           ///< one end of the range of each
  std::array<double, 2> to{};             ///< the other
  double max_radius = 0.1;  ///< of a chart, in widths of the box, and of how far unknowns go over it
  double max_turn = 0.2;    ///< of the tangent plane from a chart's centre to its rim, in radians
  std::vector<std::string> extrema_of = {};  ///< observables with gradients whose ridges are told
  long most_charts = 10000;
  double max_seconds = std::numeric_limits<double>::infinity();  ///< wall clock
  std::function<bool()> go_on = {};  ///< asked before each chart; false ends the search
};

/// A solution, corrected to rounding.
struct Chart {
  Vector unknowns;      ///< n
  Vector parameters;    ///< all of the problem's
  double radius = 0;    ///< in the scale of AtlasOptions::max_radius
  int component = 0;    ///< of the surface, as AtlasComponent
  int determinant = 0;  ///< sign of det dF/du, 0 at a fold
  int unstable = -1;    ///< how many eigenvalues have a positive real part; -1 where there are none
  int sides = 0;        ///< of the box that it lies on: 1 and 2 low and high end of the first range, 4 and 8
};

/// A point of a curve on the surface.
struct AtlasPoint {
  PointType type = PointType::regular;
  int curve = 0;      ///< its number, along which points follow each other
  Vector unknowns;    ///< n
  Vector parameters;  ///< all of the problem's
};

/// A point where dF/du is singular: a fold, a cusp where the curve of folds turns in both parameters, and
/// where it turns in one of them isola_centre or simple_bifurcation of the branches over the other one;
/// branch_point where sheets cross.
struct AtlasFold : AtlasPoint {
  int turns = -1;  ///< position among both parameters of the one that turns; else -1
};

/// A point where an observable is extremal along the branch over the first parameter: a peak or a trough;
/// fold where these meet, and the curve turns in the second parameter; where that stands still on the
/// surface, isola_centre or simple_bifurcation.
struct AtlasRidge : AtlasPoint {
  std::string observable;
};

/// A part of the surface that hangs together.
struct AtlasComponent {
  long charts = 0;
  long faces = 0;
  int euler = 0;        ///< corners - edges + faces of its triangles
  bool closed = false;  ///< whether it has no boundary: then `euler` is 2 of a sphere and 0 of a torus
};

/// What there is of the surface within the box.
struct [[nodiscard]] Atlas {
  std::vector<Chart> charts;               ///< in the order found
  std::vector<std::array<int, 3>> faces;   ///< triangles of charts, all with one orientation
  std::vector<AtlasFold> folds;            ///< on edges of triangles; closed curves end where they begin
  std::vector<AtlasRidge> ridges;          ///< the same of each observable in turn
  std::vector<AtlasComponent> components;  ///< by their first chart
  /// `reached_end` where each component is covered: its triangles end on the box's sides alone.
  Stop stop = Stop::min_step;
  std::string reason;    ///< why it is not, a clause; empty where it is
  Vector scale;          ///< n, of the unknowns, that was found for them
  long evaluations = 0;  ///< of F with its derivatives

  bool complete() const { return stop == Stop::reached_end; }
};

/// Covers the surface through each of the guesses, which share their regime and further parameters; those on
/// a component that is covered already add nothing. Of a problem in pieces the part in the guesses' regime is
/// covered, and told to be no more than that. Throws std::invalid_argument where the parameters, the ranges
/// or the number of guesses are wrong, or a guess lies outside the box.
Atlas cover(const Problem& problem, const std::vector<Guess>& starts, const AtlasOptions& options);

}  // namespace arcslip::continuation
