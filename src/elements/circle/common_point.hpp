#pragma once

// Places of the slider that let a friction circle stick for ever: those that all discs of radius b(theta)
// about w(theta) have in common. The most central one is that which the discs would have to shrink most for,
// or grow least; it is searched over a few discs at a time, to which those are added that are exceeded most,
// until none is: where a trigonometric polynomial has its maxima.

#include <vector>

#include "elements/circle/circle_motion.hpp"

namespace arcslip {

/// The most central place, with the discs that it is determined by.
struct CommonPoint {
  /// Where such a disc touches it.
  struct Touch {
    double angle;   ///< theta
    double weight;  ///< how much |w - A| - b there counts; of all together 1
  };

  Complex offset;              ///< the place A, relative to the mean of w
  double excess;               ///< by which all b have to grow for it: min over A of max of |w - A| - b
  std::vector<Touch> touches;  ///< one, two or three
  double roomiest;             ///< theta at which the disc reaches farthest beyond it
};

/// What determines it: with G = (|w - A|^2 - B^2)/2 and B = b + excess, G = G' = 0 at each touch; and the sum
/// of weight (w - A)/B is 0, that of the weights 1.
struct TouchConditions {
  TouchConditions(const CircleMotion& motion, const CommonPoint& point);  ///< of this one

  Matrix by;      ///< how they change with A, the excess, weights over B and angles
  Vector rest;    ///< what is to vanish
  Vector weight;  ///< over B
};

/// Excess over the size of the motion, below which it hardly slips, and above which it clearly does.
inline constexpr double hardly_slips = 1e-10;
inline constexpr double clearly_slips = 1e-3;

/// The search ends where the excess is above `enough`.
CommonPoint least_excess(const CircleMotion& motion, double enough);

/// The motion as it slips, with the least excess found: on the border or before it so tight that it does.
CircleMotion slipping_motion(const CircleMotion& motion, const CommonPoint& least);

/// Where a slider rests that sticks for ever: on the straight way from the most central place to that in
/// which nothing has moved it, as far as all discs let it; if there is no common place at its begin.
struct RestingPlace {
  explicit RestingPlace(const CircleMotion& motion);  ///< of this one

  Complex offset;      ///< A, relative to the mean of w
  CommonPoint centre;  ///< where the way begins; of no use where all of it is gone
  double part;         ///< of the way
  double angle;        ///< theta of the disc that ends it, if one does
};

}  // namespace arcslip
