#pragma once

// How far a periodic motion goes to either side, whatever its harmonics are. Orders of harmonics begin with
// 1; 0, even and odd ones may follow.

#include <algorithm>
#include <span>

#include "arcslip/motion/odd_motion.hpp"
#include "arcslip/motion/periodic_motion.hpp"

namespace arcslip {

/// Whether all of these orders are odd, so that a motion repeats with the opposite sign after half a period.
bool all_odd(std::span<const int> orders);

/// The highest of some orders.
inline int highest_order(std::span<const int> orders) {
  return *std::max_element(orders.begin(), orders.end());
}

/// Position of the mean among orders; their number where it is not there.
inline Index place_of_mean(std::span<const int> orders) {
  return std::find(orders.begin(), orders.end(), 0) - orders.begin();
}

/// Greatest and least value of a motion. Derivatives by an x_h have that by Re x_h and by Im x_h as real and
/// imaginary part.
struct Swing {
  OddMotion::Maximum greatest{};  ///< max x
  OddMotion::Maximum least{};     ///< min x, half a period later where all orders are odd
  bool is_odd = true;             ///< whether they are

  /// Of a motion of odd orders.
  static Swing of_odd(const OddMotion::Maximum& greatest) {
    return {greatest, {greatest.angle + pi, -greatest.value}, true};
  }
  /// Of one that has its greatest and least value at some of these angles, if there are any.
  static Swing at(const PeriodicMotion& motion, std::span<const double> angles);
  /// Of any motion.
  static Swing of(std::span<const int> orders, const HarmonicVector& x);

  /// Half of the range, with its derivative by x_h.
  double half() const { return is_odd ? greatest.value : 0.5 * (greatest.value - least.value); }
  Complex half_by(int h) const;

  /// max |x|, with its derivative by x_h.
  double peak() const { return std::max(greatest.value, -least.value); }
  Complex peak_by(int h) const;
};

/// max |x|, with its derivatives by all x_h as in Swing: where x is as far from 0 at several places, to
/// whichever side, the mean of them all.
struct Farthest {
  double value;       ///< max |x|
  HarmonicVector by;  ///< by Re x_h and Im x_h as real and imaginary part
};
Farthest farthest_of(std::span<const int> orders, const HarmonicVector& x);

}  // namespace arcslip
