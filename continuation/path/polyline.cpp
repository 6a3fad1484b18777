#include "arcslip/continuation/path/polyline.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "arcslip/continuation/path/interpolation.hpp"

namespace arcslip::continuation {
namespace {

constexpr double straight = 1.8e-3;  // of a piece's width and height, or of what is seen of it enlarged
constexpr double seen = 0.004;       // of the branch: half of what pictures enlarge
constexpr double least = 8e-4;       // of the branch: what smaller pieces count as, however enlarged
constexpr double vouched = 0.1;      // of the same: what is filled in may be off by as much
constexpr double told = 1e-4;        // of what changes along a piece: an error that is not looked into
constexpr int most_halvings = 6;

bool is_singular(const BranchPoint& point) {
  return point.type != PointType::regular && point.type != PointType::user;
}

/// The parameter, then what is drawn of a point; and behind these the logarithms of all, nan where there is
/// none.
using Coordinates = Eigen::ArrayXd;

class Polyline {
 public:
  Polyline(const Branch& branch, Index parameter, const Drawn& drawn, const Problem* problem)
      : branch_(&branch), parameter_(parameter), drawn_(drawn), problem_(problem) {
    for (const BranchPoint& point : branch.points) all_.push_back(coordinates(point));
    leave_rounding_out();
    curve_.emplace(branch, parameter, problem);
    for (std::size_t piece = 0; piece + 1 < all_.size();) {
      const Coordinates size = (all_[piece + 1] - all_[piece]).abs().max(least * extent_).min(seen * extent_);
      piece = draw(piece, size, 0);
    }
    take(branch_->points.back(), all_.back());
  }

  DrawnPoints result() {
    const Index rows = std::ssize(points_);
    const Index columns = std::ssize(values_) / rows;
    return {std::move(points_), Eigen::Map<const Matrix>(values_.data(), columns, rows).transpose()};
  }

 private:
  /// Finds the extent of what is drawn: that of rounding is none, nor has what is rounding of larger values a
  /// logarithm. What remains of larger numbers, as where a force is at its limit, may vary by many roundings.
  void leave_rounding_out() {
    constexpr double relative = 1e-9;  // of ten digits the last one
    const Index count = all_.front().size() / 2;
    Coordinates low = all_.front();
    Coordinates high = low;
    const auto widen = [&] {
      for (const Coordinates& point : all_) {  // what is not a number is left out
        low = low.isNaN().select(point, (point < low).select(point, low));
        high = high.isNaN().select(point, (point > high).select(point, high));
      }
    };
    widen();
    rounding_ = relative * low.head(count).abs().max(high.head(count).abs());
    rounding_(0) = 0;  // the parameter is what it is
    for (Coordinates& point : all_)
      point.tail(count) = (point.head(count) > rounding_).select(point.tail(count), std::nan(""));
    low.tail(count) = high.tail(count) = all_.front().tail(count);
    widen();
    extent_ = high - low;
    extent_.head(count) = (extent_.head(count) > rounding_).select(extent_.head(count), 0);
    extent_.tail(count) = (extent_.tail(count) > relative).select(extent_.tail(count), 0);
  }

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
    if (rounding_.size() == 0) rounding_.setZero(count);
    all.tail(count) = (all.head(count) > rounding_).select(all.head(count).log(), std::nan(""));
    return all;
  }

  bool is_filled(std::size_t piece) const {
    const BranchPoint& from = branch_->points[piece];
    const BranchPoint& to = branch_->points[piece + 1];
    return (to.regime == from.regime || to.type == PointType::regime_switch) && to.arclength > from.arclength;
  }

  /// Takes a piece but for its end, in parts where what is filled in is not vouched for; gives the next one.
  std::size_t draw(std::size_t piece, const Coordinates& size, int halvings) {
    const Segment whole{piece, 0, 1, all_[piece], all_[piece + 1], size};
    if (is_filled(piece)) {
      BranchPoint middle = point_between(piece, 0.5);
      const Coordinates here = coordinates(middle);
      const bool bends = !is_straight(whole, here);
      if (bends && !is_vouched_for(whole, here, halvings > 0)) {
        if (halvings < most_halvings && divide(piece)) {
          const std::size_t next = draw(piece, size, halvings + 1);
          return draw(next, size, halvings + 1);
        }
      } else if (bends) {
        take(branch_->points[piece], all_[piece]);
        split(whole, std::move(middle), here, nullptr, 0);
        return piece + 1;
      }
    }
    take(branch_->points[piece], all_[piece]);
    return piece + 1;
  }

  /// Whether the solution next to the middle of a piece is drawn there, too, unless its points tell the curve
  /// well. Where they leave it open it is looked at in its quarters as well, and parts of one that was not
  /// what its ends told as closely as straight lines are.
  bool is_vouched_for(const Segment& whole, const Coordinates& middle, bool is_part) {
    if (problem_ == nullptr) return true;
    const double doubt = curve_->doubt(whole.piece);
    // To look into sparse problems takes about as long as a step.
    if (!is_part && doubt < (problem_->sparse() ? straight : told)) return true;
    const double near = is_part ? straight : vouched;
    if (!is_at_solution(whole, 0.5, middle, near)) return false;
    if (!is_part && doubt < straight) return true;
    const auto in_quarter = [&](double x) {
      return is_at_solution(whole, x, coordinates(point_between(whole.piece, x)), near);
    };
    return in_quarter(0.25) && in_quarter(0.75);
  }

  /// Whether what is drawn of the solution next to this place is drawn as near to it.
  bool is_at_solution(const Segment& whole, double x, const Coordinates& here, double near) {
    const std::optional<Sample> sample = curve_->corrected(whole.piece, x);
    if (!sample) return false;
    BranchPoint corrected;
    corrected.regime = sample->regime;
    corrected.unknowns = sample->unknowns;
    corrected.parameters = sample->parameters;
    return is_within(near, whole, coordinates(corrected) - here);
  }

  /// Puts the solution next to the middle of a piece between its ends.
  bool divide(std::size_t piece) {
    std::optional<BranchPoint> found = curve_->solution(piece, 0.5);
    if (!found) return false;
    found->unstable = unstable(piece);
    found->residual = std::nan("");
    if (branch_ != &own_) own_.points = branch_->points;
    branch_ = &own_;
    all_.insert(all_.begin() + static_cast<std::ptrdiff_t>(piece) + 1, coordinates(*found));
    own_.points.insert(own_.points.begin() + static_cast<std::ptrdiff_t>(piece) + 1, std::move(*found));
    curve_.emplace(own_, parameter_, problem_);
    return true;
  }

  /// A point as far beyond one end of a segment as the other one lies before it.
  struct Beyond {
    const Coordinates& at;
    bool is_behind;
  };

  void fill(const Segment& segment, const Beyond& beyond, int halvings) {
    if (halvings >= most_halvings) return;
    BranchPoint point = point_between(segment.piece, 0.5 * (segment.from + segment.to));
    const Coordinates here = coordinates(point);
    if (!is_straight(segment, here)) split(segment, std::move(point), here, &beyond, halvings);
  }

  void split(const Segment& segment, BranchPoint middle, const Coordinates& here, const Beyond* beyond,
             int halvings) {
    const double x = 0.5 * (segment.from + segment.to);
    const Segment first{segment.piece, segment.from, x, segment.begin, here, segment.size};
    const Segment second{segment.piece, x, segment.to, here, segment.end, segment.size};
    const bool is_known = beyond != nullptr && are_told_straight(first, second, *beyond);
    if (!is_known) fill(first, {segment.end, true}, halvings + 1);
    take(std::move(middle), here);
    if (!is_known) fill(second, {segment.begin, false}, halvings + 1);
  }

  /// Whether the parabola through both halves' ends lies on the lines between these, and the cubic through
  /// the point beyond as well next to it that no function like these, or like sqrt(s) or |s|, is elsewhere.
  bool are_told_straight(const Segment& first, const Segment& second, const Beyond& beyond) {
    constexpr double unlike = 8;  // times what the cubic has beside the parabola
    const Coordinates& middle = first.end;
    const Coordinates& near = beyond.is_behind ? second.end : first.begin;
    const Coordinates& far = beyond.is_behind ? first.begin : second.end;
    const Coordinates bend = 2 * (far - 2 * middle + near);  // divided differences: far = 0, near = 1
    const Coordinates twist = 0.5 * (middle / 0.75 - 2 * near + beyond.at / 1.5 - bend);
    const auto is_told = [&](const Segment& half) {
      return for_all_axes(bend / 16, half, [&](Index x) {
        way_ = unlike * 3 / 64 * twist * per_size_;
        along_ = off_.abs();
        set_off(x);
        off_ = off_.abs() + along_;
        return is_off(x);
      });
    };
    return is_told(first) && is_told(second);
  }

  /// Whether the middle lies on the line from end to end, for each observable over the parameter and for both
  /// of their axes. What is not a number, or of no size, is.
  bool is_straight(const Segment& segment, const Coordinates& here) {
    return for_all_axes(here - segment.begin, segment, [&](Index x) { return is_off(x); });
  }

  /// Whether such a way leads no farther off the line from end to end, nor along it.
  bool is_within(double near, const Segment& segment, const Coordinates& way) {
    return for_all_axes(way, segment, [&](Index x) {
      along_ = way_(x) * end_(x) + way_ * end_;
      squares_ = end_(x) * end_(x) + end_.square();
      return (off_.square() > near * near * squares_ || along_.abs() > near * squares_.max(squares_.sqrt()))
          .any();
    });
  }

  /// Whether none of both of the parameter's axes is refused, with the way off the line from end to end.
  template <class IsRefused>
  bool for_all_axes(const Coordinates& way, const Segment& segment, const IsRefused& is_refused) {
    const Index count = way.size() / 2;
    per_size_ = (segment.size > 0).select(segment.size.inverse(), 0);
    end_ = (segment.end - segment.begin) * per_size_;
    for (const Index x : {Index{0}, count}) {
      way_ = way * per_size_;
      set_off(x);
      if (is_refused(x)) return false;
    }
    return true;
  }

  /// How far the way leads off the line, times its length.
  void set_off(Index x) {
    off_ = way_(x) * end_ - way_ * end_(x);
    off_(0) = off_(off_.size() / 2) = 0;  // the parameter over itself
  }

  bool is_off(Index x) const {
    return (off_.square() > straight * straight * (end_(x) * end_(x) + end_.square())).any();
  }

  BranchPoint point_between(std::size_t piece, double x) const {
    Sample sample = curve_->place(piece, x);
    BranchPoint point;
    point.regime = sample.regime;
    point.unknowns = std::move(sample.unknowns);
    point.parameters = std::move(sample.parameters);
    point.arclength = sample.arclength;
    point.residual = std::nan("");
    point.unstable = unstable(piece);
    return point;
  }

  int unstable(std::size_t piece) const {
    const BranchPoint& from = branch_->points[piece];
    return is_singular(from) ? branch_->points[piece + 1].unstable : from.unstable;
  }

  const Branch* branch_;
  Index parameter_;
  const Drawn& drawn_;
  const Problem* problem_;
  Branch own_;                    ///< with solutions more than were given, where there are any
  std::vector<Coordinates> all_;  ///< of the branch's points
  std::optional<InterpolatedBranch> curve_;
  Coordinates rounding_;  ///< of each value
  Coordinates extent_;
  Coordinates per_size_, way_, end_, off_, along_, squares_;  ///< of what was looked at last
  std::vector<BranchPoint> points_;
  std::vector<double> values_;  ///< of one after the other
};

}  // namespace

DrawnPoints polyline(const Branch& branch, Index parameter, const Drawn& drawn, const Problem* problem) {
  if (branch.points.size() < 2) {
    DrawnPoints all{branch.points, {}};
    for (const BranchPoint& point : branch.points) {
      const std::vector<double>& values = drawn(point);
      all.values = Eigen::Map<const Vector>(values.data(), std::ssize(values)).transpose();
    }
    return all;
  }
  return Polyline(branch, parameter, drawn, problem).result();
}

}  // namespace arcslip::continuation
