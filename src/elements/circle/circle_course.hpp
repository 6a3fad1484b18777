#pragma once

// The settled course of a friction circle: a spring k_t in series with a slider at A/k_t in a plane, pressed
// on it by N = max(0, n), with the force T = w - A, |T| <= b = mu N, both as complex numbers of the plane.
//
//   stick: A rests;   slip: T = b e^{i phi} by slip_panel.hpp;   apart: T = 0.
//
// Slip begins where |w - A|^2 - b^2, a trigonometric polynomial, rises through 0; it ends where its rate v
// falls to 0. Where the parts touch again A = w, and they stick if |w'| <= b', else slip with phi = arg w'.
//
// Where they come apart the period begins as they touch, and one period settles it. Else A at its begin is
// that which a period brings back: periods take all A nearer to each other, and Newton's method does so fast
// where they do so slowly.

#include <array>
#include <optional>
#include <vector>

#include "elements/circle/common_point.hpp"
#include "elements/circle/slip_panel.hpp"

namespace arcslip {

/// Such a course, arc by arc.
class CircleCourse {
 public:
  using Phase = PressedArcs::Phase;

  /// An arc in theta.
  struct Arc {
    Phase phase;                    ///< what it does
    double begin;                   ///< theta
    double width;                   ///< of theta
    Complex offset = 0;             ///< of stick: A
    std::vector<SlipPanel> panels;  ///< of slip, one behind the other
  };

  /// The settled one of a motion under which it does not stick for ever; `guess` is where the slider may be
  /// at `begin`. What does not settle has no arcs.
  CircleCourse(const CircleMotion& motion, Complex guess, double begin);

  /// Those of a period, one behind the other.
  const std::vector<Arc>& arcs() const { return arcs_; }

  /// Whether the first of them begins as the parts touch.
  bool begins_apart() const { return begins_apart_; }

  /// Of slips whose force is at their begin on either side of a line.
  FurtherSlips further_slips() const;

  /// Part of the period in this phase.
  double fraction(Phase phase) const;

 private:
  static constexpr Complex across_line{0.6, 0.8};  // one that no direction of a structure is likely to have

  void pass(Complex offset);
  void pass_contact(double begin, double end, std::optional<Complex> offset);
  double leaves(double begin, double end, Complex offset);
  SlipCount& slips_along(Complex force) { return slips_[dot(force, across_line) > 0 ? 0 : 1]; }
  double slip(double begin, double end, bool lifts, double phase);
  SlipPanel next(double begin, double end, bool lifts, double phase);
  SlipPanel stopped(SlipPanel::Reach reach, double phase) const;
  void settle(Complex guess);

  const CircleMotion& motion_;
  double begin_;
  double width_;  // that resolves slip where it was looked at last
  bool begins_apart_ = false;
  std::vector<Arc> arcs_;
  std::array<SlipCount, 2> slips_;
  bool is_endless_ = false;
  Complex moved_ = 0;  // by which the last period has moved the slider
};

}  // namespace arcslip
