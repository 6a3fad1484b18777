#pragma once

// How the arcs of a pressed contact move, with derivatives by motions and settings. With the bounds B = k_t r
// - sigma mu n of its slider, sigma the direction of slip, their ends are the roots
//
//   onset of slip     B = A     d theta = -(dB - dA)/B'
//   end of slip       B' = 0    d theta = -dB'/B"
//   apart, touching   n = 0     d theta = -dn/n'
//
// and A, which one of these sets, moves as its bound there does or, where the parts have touched, as k_t r.

#include <span>

#include "arcslip/elements/pressed/contact_readings.hpp"

namespace arcslip {

/// Adds parts of such changes to numbers, whose `by_motion` has r_h, then g_h.
class ArcEnds {
 public:
  /// Of motions under which a contact drifts, or not. They must outlive it.
  ArcEnds(const PressedSettings& settings, std::span<const int> orders, const PeriodicMotion& sliding,
          const PeriodicMotion& closing, bool drifts);

  /// n and dn/dtheta, and dr/dtheta.
  const PeriodicMotion& press() const { return press_; }
  const PeriodicMotion& press_rate() const { return press_rate_; }

  /// A number that nothing changes.
  ContactNumber zero(double value) const;

  /// Of k_t r at theta, of n and mu n, or of their slopes there.
  void add_slide(double theta, double part, bool is_slope, ContactNumber& sum) const;
  void add_press(double theta, double part, bool is_slope, ContactNumber& sum) const;
  void add_limit(double theta, double part, bool is_slope, ContactNumber& sum) const;

  /// Of A of an arc of stick, and of its `by_press`.
  void add_offset(const PressedArcs::Arc& arc, double part, ContactNumber& sum) const;
  void add_by_press(const PressedArcs::Arc& arc, double part, ContactNumber& sum) const;

  /// Of where it is set.
  void add_anchor(const PressedArcs::Arc& arc, double part, ContactNumber& sum) const;

  /// Of where slip begins behind an arc of stick, of where it ends, and of where the parts touch or part.
  void add_onset(const PressedArcs::Arc& slip, const PressedArcs::Arc& stick, double part,
                 ContactNumber& sum) const;
  void add_stop(double theta, int direction, double part, ContactNumber& sum) const;
  void add_touch(double theta, double part, ContactNumber& sum) const;

 private:
  PeriodicMotion::Local bound_slope(double theta, double by_press) const;

  const PressedSettings& settings_;
  std::span<const int> orders_;
  const PeriodicMotion& slides_;
  const PeriodicMotion& closes_;
  bool drifts_;
  PeriodicMotion press_;
  PeriodicMotion slide_rate_;
  PeriodicMotion press_rate_;
};

}  // namespace arcslip
