#pragma once

// Charts that are added to each other until they cover a surface.

#include <array>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "arcslip/continuation/atlas/atlas.hpp"
#include "arcslip/continuation/atlas/polygon.hpp"
#include "arcslip/continuation/atlas/surface.hpp"

namespace arcslip::continuation {

/// A chart as it is made.
struct Disc {
  Vector at;     ///< N, the centre
  Matrix plane;  ///< N x 2, as Surface::tangent has it
  double radius = 0;
  int sides = 0;         ///< of the box that it lies on, as bits
  int missed = 0;        ///< sides that its plane meets and the surface does not
  Polygon polygon;       ///< what lies beyond its edges: another disc, or one of those below
  bool is_torn = false;  ///< whether no disc could be added somewhere on its rim

  static constexpr int open = -1;                              ///< nothing is known to lie beyond
  static constexpr int side(int which) { return -2 - which; }  ///< that of the box
};

/// Serves one thread. The surface is kept by reference.
class Covering {
 public:
  Covering(Surface& surface, const AtlasOptions& options);

  /// Covers the surface through x, unless it is covered, with up to so many discs in all. False where it was
  /// ended before.
  bool spread(const Vector& x, std::size_t most);

  const std::vector<Disc>& discs() const { return discs_; }
  const std::string& failure() const {
    return failure_;
  }  ///< the first one, a clause; empty if there is none

  /// Moves x onto the surface, right above where it is in a disc's tangent plane; on sides of the box as near
  /// to that as these allow. False where there is no such point.
  [[nodiscard]] bool lift(const Disc& disc, Vector& x, int sides = 0);

 private:
  using Cell = std::array<long, 2>;
  struct Opening {
    Eigen::Vector2d at;  ///< in the plane
    int sides;           ///< to be put on
  };
  bool extend(std::size_t which);
  std::optional<Opening> opening(const Disc& disc) const;
  bool add(Disc disc, double radius);
  bool put(const Disc& from, const Opening& opening, Disc& disc);
  bool put_on_near_sides(Disc& disc);
  bool fit_radius(Disc& disc, double radius);
  bool is_flat(const Disc& disc, double radius);
  void outline(std::size_t which);
  double gap(const Disc& disc, int side) const;
  Eigen::Vector2d towards(const Disc& disc, int side) const;
  bool is_one_sheet(const Disc& disc, const Disc& other);
  bool is_covered(const Vector& x);
  Cell cell(const Vector& x) const;
  std::vector<std::pair<double, std::size_t>> near(const Vector& x, double radius) const;
  void fail(const Vector& x);

  Surface& surface_;
  const AtlasOptions& options_;
  Index unknowns_;
  std::vector<Disc> discs_;
  std::map<Cell, std::vector<std::size_t>> cells_;  // discs by the cells of both parameters that they lie in
  std::deque<std::size_t> unfinished_;
  std::string failure_;
  bool has_left_ = false;  // the regime, where the last disc was to be
  Matrix rows_;            // 2 x N
  Vector lifted_;
  Matrix plane_;
};

}  // namespace arcslip::continuation
