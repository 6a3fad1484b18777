#include "arcslip/elements/circle/circle_contact.hpp"

#include <Eigen/LU>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "arcslip/elements/element.hpp"
#include "arcslip/motion/swing.hpp"
#include "elements/circle/circle_changes.hpp"
#include "elements/circle/circle_law.hpp"
#include "elements/pressed/arc_sums.hpp"

namespace arcslip {
namespace {

using Course = PressedArcs::Course;
using Phase = PressedArcs::Phase;

/// Forces and derivatives as sums over arcs.
class CircleIntegrals {
 public:
  CircleIntegrals(const CircleMotion& motion, std::span<const int> orders)
      : motion_(motion), orders_(orders), stick_(2 * motion.highest()), touch_(2 * motion.highest()) {
    out_.harmonics.setZero(3 * n());
  }

  /// With the slider at a place for ever.
  template <class Place>
  CircleForce stuck(const Place& place, bool derivatives) {
    const ArcSums period(2 * motion_.highest(), 0, two_pi);
    stick_.add(period);
    touch_.add(period);
    add_arcs();
    const Index mean = place_of_mean(orders_);
    if (mean < n()) {
      const Complex offset = place.offset + motion_.mean();
      out_.harmonics(mean) -= offset.real();
      out_.harmonics(n() + mean) -= offset.imag();
    }
    if (!derivatives) return std::move(out_);
    const CircleColumns columns(motion_, orders_);
    CircleChanges changes{
        Matrix::Zero(2 * n(), columns.size()), Matrix::Zero(2 * n(), columns.size()), {}, {}, {}};
    if (mean < n()) {
      const Matrix offset = changes_of(motion_, place, columns);
      changes.x.row(mean) = -offset.row(0);
      changes.y.row(mean) = -offset.row(1);
    }
    add_derivatives(changes, columns);
    return std::move(out_);
  }

  /// Slipping, or apart, now and then.
  CircleForce moved(const CircleCourse& course, bool derivatives) {
    if (course.arcs().empty()) {
      set_unknown();
      return std::move(out_);
    }
    for (const CircleCourse::Arc& arc : course.arcs()) {
      if (arc.phase == Phase::apart) continue;
      const ArcSums own(2 * motion_.highest(), arc.begin, arc.width);
      touch_.add(own);
      if (arc.phase == Phase::stick) stick_.add(own);
    }
    add_arcs();
    const CircleColumns columns(motion_, derivatives ? orders_ : std::span<const int>());
    CircleChanges changes = changes_of(motion_, course, columns, orders_);
    for (Index a = 0; a < n(); ++a) {
      out_.harmonics(a) += Complex(changes.force_x(a), changes.force_x(n() + a));
      out_.harmonics(n() + a) += Complex(changes.force_y(a), changes.force_y(n() + a));
    }
    if (motion_.mean() != 0.0) remove_mean();
    out_.slip_fraction = course.fraction(Phase::slip);
    out_.apart_fraction = course.fraction(Phase::apart);
    out_.further_slips = course.further_slips();
    if (!derivatives) return std::move(out_);
    close_period(course, changes);
    add_derivatives(changes, columns);
    return std::move(out_);
  }

 private:
  Index n() const { return std::ssize(orders_); }

  /// What does not settle is not a number, which shortens the step of who asks.
  void set_unknown() {
    constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
    out_.harmonics.setConstant(unknown);
    out_.linear.setConstant(3 * n(), 3 * n(), unknown);
    out_.conjugate.setConstant(3 * n(), 3 * n(), unknown);
    for (ComplexVector& by : out_.by) by.setConstant(3 * n(), unknown);
  }

  void add_arcs() {
    const double k = motion_.settings().tangential_stiffness;
    out_.harmonics.head(n()) += k * stick_.harmonics(motion_.x(), orders_);
    out_.harmonics.segment(n(), n()) += k * stick_.harmonics(motion_.y(), orders_);
    out_.harmonics.tail(n()) = touch_.harmonics(motion_.press(), orders_);
  }

  /// In stick places are told relative to the mean of k_t r.
  void remove_mean() {
    const ComplexVector constant = stick_.harmonics(PeriodicMotion(ComplexVector::Ones(1)), orders_);
    out_.harmonics.head(n()) -= motion_.mean().real() * constant;
    out_.harmonics.segment(n(), n()) -= motion_.mean().imag() * constant;
  }

  /// A comes back after the period, whatever changes.
  static void close_period(const CircleCourse& course, CircleChanges& changes) {
    if (course.begins_apart() || course.arcs().front().phase == Phase::apart) return;
    const Index last = changes.offset.cols() - 2;
    const Matrix start = start_of(changes);
    changes.x.leftCols(last) += changes.x.rightCols<2>() * start;
    changes.y.leftCols(last) += changes.y.rightCols<2>() * start;
  }

  void add_derivatives(const CircleChanges& changes, const CircleColumns& columns) {
    const double k = motion_.settings().tangential_stiffness;
    out_.linear.setZero(3 * n(), 3 * n());
    out_.conjugate.setZero(3 * n(), 3 * n());
    put(stick_.derivative(orders_, k), 0);
    put(stick_.derivative(orders_, k), 1);
    put(touch_.derivative(orders_, motion_.settings().normal_stiffness), 2);
    for (Index c = 0; c < 3; ++c) {
      for (Index b = 0; b < n(); ++b) {
        const ComplexVector by_real = column(changes, 2 * c * n() + b);
        const ComplexVector by_imaginary = column(changes, (2 * c + 1) * n() + b) * Complex(0, 1);
        out_.linear.col(c * n() + b).head(2 * n()) += 0.5 * (by_real - by_imaginary);
        out_.conjugate.col(c * n() + b).head(2 * n()) += 0.5 * (by_real + by_imaginary);
      }
    }
    for (Index s = 0; s < PressedForce::settings; ++s) {
      ComplexVector& by = out_.by[static_cast<std::size_t>(s)];
      by.setZero(3 * n());
      by.head(2 * n()) = column(changes, columns.settings() + s);
    }
    ComplexVector& by_stiffness = out_.by[PressedForce::tangential_stiffness];
    by_stiffness.head(n()) += stick_.harmonics(motion_.x(), orders_);
    by_stiffness.segment(n(), n()) += stick_.harmonics(motion_.y(), orders_);
    out_.by[PressedForce::normal_stiffness].tail(n()) = touch_.harmonics(motion_.closing(), orders_);
    out_.by[PressedForce::normal_force].tail(n()) =
        touch_.harmonics(PeriodicMotion(ComplexVector::Ones(1)), orders_);
  }

  /// Of both forces, as complex harmonics.
  ComplexVector column(const CircleChanges& changes, Index which) const {
    ComplexVector all(2 * n());
    for (Index a = 0; a < n(); ++a) {
      all(a) = Complex(changes.x(a, which), changes.x(n() + a, which));
      all(n() + a) = Complex(changes.y(a, which), changes.y(n() + a, which));
    }
    return all;
  }

  void put(const HarmonicDerivative& part, Index coordinate) {
    out_.linear.block(coordinate * n(), coordinate * n(), n(), n()) += part.linear;
    out_.conjugate.block(coordinate * n(), coordinate * n(), n(), n()) += part.conjugate;
  }

  const CircleMotion& motion_;
  std::span<const int> orders_;
  ArcSums stick_;
  ArcSums touch_;
  CircleForce out_;
};

/// What the most central place tells of it.
CircleRoom room_of(const CircleMotion& moves, std::span<const int> orders, const CommonPoint& point) {
  const CircleColumns columns(moves, orders);
  Eigen::RowVectorXd row = Eigen::RowVectorXd::Zero(columns.size());
  for (const CommonPoint::Touch& touch : point.touches) {
    const CircleMotion::Local here = moves.at(touch.angle);
    const Complex pull = here.centre - point.offset;
    const double far = std::abs(pull);
    const bool is_one = point.touches.size() == 1;  // at the centre of a disc within all others
    columns.add(touch.angle, {.centre = is_one ? 0 : touch.weight / far * pull, .radius = -touch.weight},
                row);
  }
  const ContactNumber excess = columns.number(point.excess, row);
  return {excess.value, excess.by_motion, excess.by};
}

/// Where the excess is hardly anything, or on the other side of the border: between what the force is at the
/// border, where the slider has one place, and under a circle of such a size that the excess is just so, in
/// proportion to the excess. The force changes as a root of that, so that no derivative at the border would
/// do.
class BesideBorder {
 public:
  /// With the most central place of a motion. An excess just so is on the side of slip if it is positive.
  BesideBorder(const CircleMotion& motion, std::span<const int> orders, const CommonPoint& point,
               double just_so)
      : motion_(motion),
        orders_(orders),
        point_(point),
        just_so_(just_so),
        other_(motion.tightened(just_so - point.excess)) {
    constexpr double farthest = 1e5;  // parts on the other side, lest they lose all digits
    const double ratio = point.excess / just_so;
    const double bound = ratio < 0 ? 1 / (1 - ratio / farthest) : 1;
    part_ = ratio * bound;
    part_by_excess_ = bound * bound / just_so;
  }

  CircleForce force(bool derivatives) const {
    const CircleForce there = just_so(derivatives);
    CircleForce out = CircleIntegrals(motion_, orders_).stuck(point_, derivatives);
    const Index sliding = 2 * std::ssize(orders_);
    const ComplexVector more = there.harmonics.head(sliding) - out.harmonics.head(sliding);
    out.harmonics.head(sliding) += part_ * more;
    out.slip_fraction = there.slip_fraction;
    if (derivatives) add_derivatives(there, more, out);
    return out;
  }

 private:
  CircleForce just_so(bool derivatives) const {
    CircleIntegrals integrals(other_, orders_);
    return just_so_ > 0 ? integrals.moved(CircleCourse(other_, point_.offset, point_.roomiest), derivatives)
                        : integrals.stuck(RestingPlace(other_), derivatives);
  }

  void add_derivatives(const CircleForce& there, const ComplexVector& more, CircleForce& out) const {
    const Index sliding = more.size();
    const CircleRoom room = room_of(motion_, orders_, point_);
    const double friction = motion_.settings().friction;
    const ComplexVector by_press = there.by[PressedForce::normal_force].head(sliding);
    const ComplexVector by_excess = part_by_excess_ * more + (part_ / friction) * by_press;
    const auto between = [&](auto&& from, const auto& to) { from += part_ * (to - from); };
    between(out.linear.topRows(sliding), there.linear.topRows(sliding));
    between(out.conjugate.topRows(sliding), there.conjugate.topRows(sliding));
    out.linear.topRows(sliding) += 0.5 * by_excess * room.by_motion.adjoint();
    out.conjugate.topRows(sliding) += 0.5 * by_excess * room.by_motion.transpose();
    for (std::size_t s = 0; s < PressedForce::settings; ++s) {
      between(out.by[s].head(sliding), there.by[s].head(sliding));
      out.by[s].head(sliding) += room.by[s] * by_excess;
    }
    out.by[PressedForce::friction].head(sliding) +=
        part_ * (just_so_ - point_.excess) / (friction * friction) * by_press;
  }

  const CircleMotion& motion_;
  std::span<const int> orders_;
  const CommonPoint& point_;
  double just_so_;
  CircleMotion other_;
  double part_;
  double part_by_excess_;
};

CircleForce sticking(const CircleMotion& motion, std::span<const int> orders, bool derivatives) {
  const RestingPlace place(motion);
  const double just_so = -hardly_slips * motion.size();
  if (place.part < 1 && place.centre.excess > just_so)
    return BesideBorder(motion, orders, place.centre, just_so).force(derivatives);
  return CircleIntegrals(motion, orders).stuck(place, derivatives);
}

CircleForce slipping(const CircleMotion& motion, std::span<const int> orders, bool derivatives) {
  const CommonPoint point = least_excess(motion, clearly_slips * motion.size());
  const double just_so = hardly_slips * motion.size();
  if (point.excess < just_so) return BesideBorder(motion, orders, point, just_so).force(derivatives);
  return CircleIntegrals(motion, orders)
      .moved(CircleCourse(motion, point.offset, point.roomiest), derivatives);
}

}  // namespace

CircleForce circle_force(const PressedSettings& settings, std::span<const int> orders,
                         const ComplexVector& motion, bool derivatives, PressedArcs::Course course) {
  const CircleMotion moves = CircleMotion::of(settings, orders, motion);
  const Index n = std::ssize(orders);
  bool sticks = course == Course::sticks;
  if (course == Course::any) sticks = least_excess(moves, 0).excess <= 0;
  CircleForce out = sticks ? sticking(moves, orders, derivatives) : slipping(moves, orders, derivatives);
  out.energy = cycle_energy(orders, out.harmonics.head(n), motion.head(n)) +
               cycle_energy(orders, out.harmonics.segment(n, n), motion.segment(n, n));
  return out;
}

DisturbedLaw circle_law(const PressedSettings& settings, std::span<const int> orders,
                        const ComplexVector& motion, bool slips, double turn) {
  const CircleMotion moves = CircleMotion::of(settings, orders, motion);
  const bool closes = motion.size() == 3 * std::ssize(orders);
  if (!slips) {
    Vector stiffness = Vector::Constant(closes ? 3 : 2, settings.tangential_stiffness);
    if (closes) stiffness(2) = settings.normal_stiffness;
    return DisturbedLaw::constant(stiffness.asDiagonal());
  }
  const CommonPoint point = least_excess(moves, clearly_slips * moves.size());
  const CircleMotion beyond = slipping_motion(moves, point);
  const CircleCourse course(beyond, point.offset, point.roomiest);
  if (course.arcs().empty()) throw std::domain_error("friction in a plane does not settle");
  return circle_law(beyond, course, closes, turn);
}

CircleRoom circle_room(const PressedSettings& settings, std::span<const int> orders,
                       const ComplexVector& motion) {
  const CircleMotion moves = CircleMotion::of(settings, orders, motion);
  const CommonPoint point = least_excess(moves, std::numeric_limits<double>::infinity());
  CircleRoom room = room_of(moves, orders, point);
  room.by_motion.conservativeResize(motion.size());
  return room;
}

}  // namespace arcslip
