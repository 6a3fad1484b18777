#include "arcslip/elements/circle/circle_readings.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "elements/circle/circle_changes.hpp"

namespace arcslip {
namespace {

using CircleArc = CircleCourse::Arc;
using Phase = PressedArcs::Phase;
using Row = Eigen::RowVectorXd;
using Share = CircleColumns::Share;

/// Goes through the arcs of a course, or the one of a slider that rests.
class CircleReader {
 public:
  CircleReader(const CircleMotion& motion, std::span<const int> orders, bool derivatives)
      : motion_(motion), columns_(motion, orders), derivatives_(derivatives), centre_(only_centre(motion)) {}

  ContactReadings stuck(const RestingPlace& place) {
    arcs_ = {{Phase::stick, 0, two_pi, place.offset, {}}};
    if (derivatives_) changes_.arcs = {{changes_of(motion_, place, columns_), {}}};
    return read();
  }

  ContactReadings moved(const CircleCourse& course, std::span<const int> orders) {
    arcs_ = course.arcs();
    if (derivatives_) changes_ = changes_of(motion_, course, columns_, orders);
    const bool comes_back = !course.begins_apart() && arcs_.front().phase != Phase::apart;
    if (derivatives_ && comes_back) start_ = start_of(changes_);
    return read();
  }

 private:
  static CircleMotion only_centre(const CircleMotion& motion) {
    PressedSettings settings = motion.settings();
    settings.friction = 0;
    return {settings, motion.x(), motion.y(), motion.closing()};
  }

  ContactReadings read() const {
    constexpr double rounding = 1e-13;  // of an arc that is none
    Row slip = Row::Zero(columns_.size());
    Row apart = slip;
    double slips = 0;
    double comes_apart = 0;
    double whole = 0;  // 2 pi but for what is rounding
    for (std::size_t i = 0; i < arcs_.size(); ++i) {
      const CircleArc& arc = arcs_[i];
      if (!(arc.width > rounding)) continue;
      whole += arc.width;
      if (arc.phase == Phase::stick) continue;
      (arc.phase == Phase::slip ? slips : comes_apart) += arc.width;
      if (!derivatives_ || arcs_.size() == 1 || !(arc.width > narrow)) continue;
      (arc.phase == Phase::slip ? slip : apart) += end_of(i) - begin_of(i);
    }
    const auto [traction, by] = greatest();
    return {number(traction, by), number(slips / whole, slip / two_pi),
            number(comes_apart / whole, apart / two_pi)};
  }

  /// A changes along with what brings it back after the period.
  ContactNumber number(double value, const Row& row) const {
    Row all = row;
    if (start_.size() > 0) all.head(start_.cols()) += row.tail<2>() * start_;
    return columns_.number(value, all);
  }

  Row of(double theta, const Share& share) const {
    Row row = Row::Zero(columns_.size());
    columns_.add(theta, share, row);
    return row;
  }

  /// The arc beside one, if it is another one: not what goes on over the end of the period, nor where slip
  /// stops for nothing.
  const CircleArc* beside(std::size_t i, std::size_t steps) const {
    const CircleArc& other = arcs_[(i + steps) % arcs_.size()];
    return other.phase == arcs_[i].phase || !(other.width > narrow) ? nullptr : &other;
  }

  /// How the ends of an arc move.
  Row begin_of(std::size_t i) const {
    const CircleArc* before = beside(i, arcs_.size() - 1);
    const CircleArc& arc = arcs_[i];
    if (before == nullptr) return Row::Zero(columns_.size());
    if (arc.phase == Phase::apart || before->phase == Phase::apart) return touch(arc.begin);
    return onset(arc, *before);
  }
  Row end_of(std::size_t i) const {
    const CircleArc* behind = beside(i, 1);
    const CircleArc& arc = arcs_[i];
    if (behind == nullptr) return Row::Zero(columns_.size());
    if (arc.phase == Phase::apart || behind->phase == Phase::apart) return touch(arc.begin + arc.width);
    return stop(i);
  }

  Row touch(double theta) const { return of(theta, {.radius = -1 / motion_.at(theta).radius_rate}); }

  Row onset(const CircleArc& slip, const CircleArc& stick) const {
    const CircleMotion::Local here = motion_.at(slip.begin);
    const Complex toward = std::polar(1.0, std::arg(here.centre - stick.offset));
    const Row excess = traction(slip.begin, toward, stick) - of(slip.begin, {.radius = 1});
    return -excess / (dot(toward, here.rate) - here.radius_rate);
  }

  Row stop(std::size_t i) const {
    constexpr Index last = panel_nodes - 1;
    const SlipPanel& panel = arcs_[i].panels.back();
    const double theta = panel.angle(last);
    const CircleMotion::Local here = motion_.at(theta);
    const Complex toward = std::polar(1.0, panel.phase(last));
    const double across = cross(toward, here.rate);
    const double slope = dot(toward, here.bend) + across * panel.turning(last) - here.radius_bend;
    const Row change =
        of(theta, {.rate = toward, .radius_rate = -1}) + across * changes_.arcs[i].direction_at_end;
    return -change / slope;
  }

  /// u (dw - dA) on an arc of stick.
  Row traction(double theta, Complex toward, const CircleArc& stick) const {
    const Matrix& offset = changes_.arcs[static_cast<std::size_t>(&stick - arcs_.data())].offset;
    return of(theta, {.centre = toward}) - toward.real() * offset.row(0) - toward.imag() * offset.row(1);
  }

  /// A place where |T| may be greatest.
  struct Place {
    std::size_t arc;
    double theta;
    double force;
  };

  void add_place(std::size_t i, double theta, std::vector<Place>& places) const {
    const CircleMotion::Local here = motion_.at(theta);
    const bool sticks = arcs_[i].phase == Phase::stick;
    places.push_back({i, theta, sticks ? std::abs(here.centre - arcs_[i].offset) : here.radius});
  }

  std::vector<Place> places() const {
    const std::vector<double> presses = motion_.press().derivative().zeros();
    std::vector<Place> all;
    for (std::size_t i = 0; i < arcs_.size(); ++i) {
      const CircleArc& arc = arcs_[i];
      if (arc.phase == Phase::apart || !(arc.width > 0)) continue;
      const bool sticks = arc.phase == Phase::stick;
      add_place(i, arc.begin, all);
      if (!sticks) add_place(i, arc.begin + arc.width, all);
      for (const double angle : sticks ? centre_.excess(arc.offset, 0).derivative().zeros() : presses) {
        const double way = angle - arc.begin;
        const double turned = way - two_pi * std::floor(way / two_pi);
        if (turned < arc.width) add_place(i, arc.begin + turned, all);
      }
    }
    return all;
  }

  std::pair<double, Row> greatest() const {
    constexpr double rounding = 1e-11;
    const std::vector<Place> all = places();
    double most = 0;
    for (const Place& place : all) most = std::max(most, place.force);
    Row sum = Row::Zero(columns_.size());
    if (!derivatives_ || !(most > 0)) return {most, sum};
    int count = 0;
    for (const Place& place : all) {
      if (place.force < (1 - rounding) * most) continue;
      sum += force_of(place);
      ++count;
    }
    return {most, sum / count};
  }

  Row force_of(const Place& place) const {
    const CircleArc& arc = arcs_[place.arc];
    const CircleMotion::Local here = motion_.at(place.theta);
    if (arc.phase == Phase::stick)
      return traction(place.theta, (here.centre - arc.offset) / std::abs(here.centre - arc.offset), arc);
    Row row = of(place.theta, {.radius = 1});
    if (place.theta == arc.begin && here.radius_rate != 0) row += here.radius_rate * begin_of(place.arc);
    return row;
  }

  static constexpr double narrow = 1e-9;  // of theta

  const CircleMotion& motion_;
  CircleColumns columns_;
  bool derivatives_;
  CircleMotion centre_;  // without friction
  std::vector<CircleArc> arcs_;
  CircleChanges changes_;
  Matrix start_;  // how A changes where the period begins
};

}  // namespace

ContactReadings circle_readings(const PressedSettings& settings, std::span<const int> orders,
                                const ComplexVector& motion, bool slips, bool derivatives) {
  const CircleMotion moves = CircleMotion::of(settings, orders, motion);
  if (!slips) return CircleReader(moves, orders, derivatives).stuck(RestingPlace(moves));
  const CommonPoint point = least_excess(moves, clearly_slips * moves.size());
  const CircleMotion beyond = slipping_motion(moves, point);
  const CircleCourse course(beyond, point.offset, point.roomiest);
  if (!course.arcs().empty()) return CircleReader(beyond, orders, derivatives).moved(course, orders);
  constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  const ContactNumber none{unknown, ComplexVector::Constant(3 * std::ssize(orders), unknown), {}};
  return {none, none, none};
}

}  // namespace arcslip
