#pragma once

// Convex polygons in a tangent plane, cut by straight lines.

#include <Eigen/Core>
#include <algorithm>
#include <vector>

namespace arcslip::continuation {

/// Around the origin at first, corners in the order in which they are turned to from the first axis to the
/// second.
class Polygon {
 public:
  struct Corner {
    Eigen::Vector2d at;
    int beyond;  ///< what lies beyond the edge that leads to the next corner
  };

  Polygon() = default;

  /// A regular hexagon around a circle, with nothing known beyond it: `unknown`.
  Polygon(double radius, int unknown) {
    constexpr double sixth = 1.0471975511965976;  // pi/3
    const double length = radius / std::cos(sixth / 2);
    for (int i = 0; i < 6; ++i)
      corners_.push_back({{length * std::cos(i * sixth), length * std::sin(i * sixth)}, unknown});
  }

  const std::vector<Corner>& corners() const { return corners_; }
  std::size_t before(std::size_t i) const { return (i + corners_.size() - 1) % corners_.size(); }
  std::size_t after(std::size_t i) const { return (i + 1) % corners_.size(); }

  /// How far it reaches along a direction.
  double reach(const Eigen::Vector2d& direction) const {
    double most = -1e300;
    for (const Corner& corner : corners_) most = std::max(most, corner.at.dot(direction));
    return most;
  }

  /// Leaves direction . s <= offset of it; `beyond` lies behind the new edge.
  void cut(const Eigen::Vector2d& direction, double offset, int beyond) {
    std::vector<Corner> left;
    for (std::size_t i = 0; i < corners_.size(); ++i) {
      const Corner& here = corners_[i];
      const Corner& next = corners_[after(i)];
      const double a = here.at.dot(direction) - offset;
      const double b = next.at.dot(direction) - offset;
      if (a <= 0) left.push_back(here);
      if ((a <= 0) == (b <= 0)) continue;
      left.push_back({here.at + a / (a - b) * (next.at - here.at), a <= 0 ? beyond : here.beyond});
    }
    corners_ = std::move(left);
  }

 private:
  std::vector<Corner> corners_;
};

}  // namespace arcslip::continuation
