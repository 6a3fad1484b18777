#include "arcslip/continuation/path/polyline.hpp"

#include <algorithm>
#include <cmath>

#include "arcslip/continuation/path/interpolation.hpp"

namespace arcslip::continuation {
namespace {

constexpr double straight = 1.8e-3;  // of a piece's width and height, or of what is seen of it enlarged
constexpr double seen = 0.004;       // of the branch: half of what pictures enlarge
constexpr double least = 8e-4;       // of the branch: what smaller pieces count as, however enlarged
constexpr int most_halvings = 6;

bool is_singular(const BranchPoint& point) {
  return point.type != PointType::regular && point.type != PointType::user;
}

/// The parameter, then what is drawn of a point; and behind these the logarithms of all, nan where there is
/// none.
using Coordinates = Eigen::ArrayXd;

class Polyline {
 public:
  Polyline(const Branch& branch, Index parameter, const Drawn& drawn)
      : branch_(branch), parameter_(parameter), drawn_(drawn), curve_(branch, parameter) {
    std::vector<Coordinates> all;
    for (const BranchPoint& point : branch.points) all.push_back(coordinates(point));
    Coordinates low = all.front();
    Coordinates high = low;
    for (const Coordinates& point : all) {  // what is not a number is left out
      low = low.isNaN().select(point, (point < low).select(point, low));
      high = high.isNaN().select(point, (point > high).select(point, high));
    }
    extent_ = high - low;
    for (std::size_t piece = 0; piece + 1 < all.size(); ++piece) {
      take(branch.points[piece], all[piece]);
      const BranchPoint& next = branch.points[piece + 1];
      const bool is_one = next.regime == branch.points[piece].regime || next.type == PointType::regime_switch;
      const Coordinates size = (all[piece + 1] - all[piece]).abs().max(least * extent_).min(seen * extent_);
      if (is_one && next.arclength > branch.points[piece].arclength)
        fill({piece, 0, 1, all[piece], all[piece + 1], size}, 0);
    }
    take(branch.points.back(), all.back());
  }

  DrawnPoints result() {
    const Index rows = std::ssize(points_);
    const Index columns = std::ssize(values_) / rows;
    return {std::move(points_), Eigen::Map<const Matrix>(values_.data(), columns, rows).transpose()};
  }

 private:
  struct Segment {
    std::size_t piece;
    double from, to;  ///< parts of the piece
    const Coordinates& begin;
    const Coordinates& end;
    const Coordinates& size;  ///< of the whole piece, as far as it is seen at once
  };

  void take(BranchPoint point, const Coordinates& at) {
    points_.push_back(std::move(point));
    values_.insert(values_.end(), at.begin() + 1, at.begin() + at.size() / 2);
  }

  Coordinates coordinates(const BranchPoint& point) {
    const std::vector<double>& values = drawn_(point);
    const Index count = 1 + std::ssize(values);
    Coordinates all(2 * count);
    all(0) = point.parameters(parameter_);
    std::copy(values.begin(), values.end(), all.data() + 1);
    all.tail(count) = (all.head(count) > 0).select(all.head(count).log(), std::nan(""));
    return all;
  }

  void fill(const Segment& segment, int halvings) {
    const double middle = 0.5 * (segment.from + segment.to);
    BranchPoint point = point_between(segment.piece, middle);
    const Coordinates here = coordinates(point);
    if (halvings >= most_halvings || is_straight(segment, here)) return;
    fill({segment.piece, segment.from, middle, segment.begin, here, segment.size}, halvings + 1);
    take(std::move(point), here);
    fill({segment.piece, middle, segment.to, here, segment.end, segment.size}, halvings + 1);
  }

  /// Whether the middle lies on the line from end to end, for each observable over the parameter and for both
  /// of their axes. What is not a number, or of no size, is.
  bool is_straight(const Segment& segment, const Coordinates& here) {
    const Index count = here.size() / 2;
    per_size_ = (segment.size > 0).select(segment.size.inverse(), 0);
    middle_ = (here - segment.begin) * per_size_;
    end_ = (segment.end - segment.begin) * per_size_;
    for (const Index x : {Index{0}, count}) {
      off_ = middle_(x) * end_ - middle_ * end_(x);
      off_(0) = off_(count) = 0;  // the parameter over itself
      if ((off_.square() > straight * straight * (end_(x) * end_(x) + end_.square())).any()) return false;
    }
    return true;
  }

  BranchPoint point_between(std::size_t piece, double x) const {
    const BranchPoint& from = branch_.points[piece];
    Sample sample = curve_.place(piece, x);
    BranchPoint point;
    point.regime = sample.regime;
    point.unknowns = std::move(sample.unknowns);
    point.parameters = std::move(sample.parameters);
    point.arclength = sample.arclength;
    point.residual = std::nan("");
    point.unstable = is_singular(from) ? branch_.points[piece + 1].unstable : from.unstable;
    return point;
  }

  const Branch& branch_;
  Index parameter_;
  const Drawn& drawn_;
  InterpolatedBranch curve_;
  Coordinates extent_;
  Coordinates per_size_, middle_, end_, off_;  ///< of the last segment that was looked at
  std::vector<BranchPoint> points_;
  std::vector<double> values_;  ///< of one after the other
};

}  // namespace

DrawnPoints polyline(const Branch& branch, Index parameter, const Drawn& drawn) {
  if (branch.points.size() < 2) {
    DrawnPoints all{branch.points, {}};
    for (const BranchPoint& point : branch.points) {
      const std::vector<double>& values = drawn(point);
      all.values = Eigen::Map<const Vector>(values.data(), std::ssize(values)).transpose();
    }
    return all;
  }
  return Polyline(branch, parameter, drawn).result();
}

}  // namespace arcslip::continuation
