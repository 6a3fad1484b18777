#pragma once

// How the force of a friction circle changes with its motion, exactly: in stick as w - A, in slip by the
// linearised equation of phi at the same points,
//
//   b (delta phi)' + Re(w' e^{-i phi}) delta phi = Im(delta w' e^{-i phi}) - phi' delta b.
//
// The force is continuous, so that moving ends of arcs do not count, but where the parts touch again.

#include <span>
#include <vector>

#include "arcslip/elements/pressed/contact_readings.hpp"
#include "elements/circle/circle_course.hpp"

namespace arcslip {

/// Changes of the motion, a column each: Re and Im of the harmonics of both sliding displacements and of the
/// closing one, then mu, k_t, k_n and N_0, then both parts of A as the period begins.
class CircleColumns {
 public:
  /// Of motions with these orders, which must outlive the columns; of none those of A alone.
  CircleColumns(const CircleMotion& motion, std::span<const int> orders) : motion_(motion), orders_(orders) {}

  /// How many there are.
  Index size() const { return orders_.empty() ? 2 : 6 * harmonics() + 6; }
  Index harmonics() const { return std::ssize(orders_); }
  Index settings() const { return 6 * harmonics(); }  ///< the first of these

  /// What a change counts by that is a sum over the parts of delta w, delta w', delta b and delta b'.
  struct Share {
    Complex centre = 0;
    Complex rate = 0;
    double radius = 0;
    double radius_rate = 0;
  };
  /// Adds what each column has of it at theta.
  void add(double theta, const Share& share, Eigen::Ref<Eigen::RowVectorXd> row) const;

  /// A number of which a row has the derivatives.
  ContactNumber number(double value, const Eigen::RowVectorXd& row) const;

 private:
  void add_settings(double theta, const Share& share, Eigen::Ref<Eigen::RowVectorXd> row) const;

  const CircleMotion& motion_;
  std::span<const int> orders_;
};

/// Changes of a force's harmonics and of A.
struct CircleChanges {
  Matrix x;       ///< Re of the harmonics of the arcs of slip and of -A in those of stick, then Im; x columns
  Matrix y;       ///< along the other direction
  Matrix offset;  ///< of A at the end of the period, two rows
  Vector force_x;  ///< that force itself
  Vector force_y;  ///< along the other direction

  /// What changes on one arc.
  struct Arc {
    Matrix offset;                        ///< A in stick, two rows
    Eigen::RowVectorXd direction_at_end;  ///< of phi where slip ends
  };
  std::vector<Arc> arcs = {};  ///< of a course
};

/// Of a course.
CircleChanges changes_of(const CircleMotion& motion, const CircleCourse& course, const CircleColumns& columns,
                         std::span<const int> orders);

/// How A at the begin changes with the other columns, as it comes back after the period.
Matrix start_of(const CircleChanges& changes);

/// Of A at the end of the period by A at its begin.
Eigen::Matrix2d offset_by_offset(const CircleMotion& motion, const CircleCourse& course);

/// Of the most central place, two rows.
Matrix changes_of(const CircleMotion& motion, const CommonPoint& point, const CircleColumns& columns);

/// Of the place of a slider that sticks for ever, two rows.
Matrix changes_of(const CircleMotion& motion, const RestingPlace& place, const CircleColumns& columns);

}  // namespace arcslip
