#pragma once

// What acts along one coordinate of the interface: a force that follows from the coordinate's motion x(t)
// over a period and from the load that presses the parts together, f = f(x; load), in several odd harmonics.

#include <span>

#include "arcslip/elements/varying_stiffness.hpp"
#include "arcslip/motion/odd_motion.hpp"

namespace arcslip {

/// The force of an element, with its derivatives: df_h = sum_l linear(h, l) dx_l + conjugate(h, l)
/// conj(dx_l).
struct ElementForce {
  HarmonicVector harmonics;      ///< f_h, against x
  HarmonicVector by_log_load;    ///< df_h/d ln(load)
  ComplexMatrix linear;          ///< harmonics x harmonics
  ComplexMatrix conjugate;       ///< the same
  double energy = 0;             ///< lost per cycle
  OddMotion::Maximum maximum{};  ///< of the motion, where the force was found from it

  /// k x, whatever the load is.
  void set_linear(double stiffness, const HarmonicVector& x, bool derivatives);

  /// Adds so much of a change.
  void add(const ElementForce& change, double part);
};

/// Where a state of an element ends.
struct StateBorder {
  double value;              ///< negative inside
  HarmonicVector by_motion;  ///< derivatives by Re x_h and Im x_h as real and imaginary part
  double by_log_load;        ///< by ln(load)
};

/// Immutable, and used from all threads.
class Element {
 public:
  virtual ~Element() = default;

  /// The stiffness, > 0, relative to which the force is measured: that of the stuck state, if there is one.
  virtual double reference_stiffness() const = 0;

  /// Whether it sticks or slips, with a border in between; else its force is smooth.
  virtual bool may_slip() const { return false; }

  /// Whether the force is reference_stiffness() x in this state.
  virtual bool is_linear(bool slips) const = 0;

  /// The force under the motion x with these orders; all but harmonics and energy only with `derivatives`. No
  /// motion that slips is zero. Allocates nothing where the sizes are those of before.
  virtual void force(std::span<const int> orders, const HarmonicVector& x, double load, bool slips,
                     bool derivatives, ElementForce& out) const = 0;

  /// How harmonics and derivatives, which `force` has given as `at` with these arguments, change with x and
  /// with ln(load). Of the energy and the maximum nothing is said.
  ElementForce change(const ElementForce& at, std::span<const int> orders, const HarmonicVector& x,
                      double load, bool slips, const HarmonicVector& motion, double log_load) const;

  /// What small disturbances of the motion x meet in an element that does not slip; one that slips has a
  /// memory and no such stiffness.
  virtual VaryingStiffness stiffness_in_time(std::span<const int> orders, const HarmonicVector& x) const = 0;

  /// The border of one that may slip, smooth where the motion is zero; `top` is the motion's maximum.
  virtual StateBorder border(std::span<const int> orders, const OddMotion::Maximum& top, double load,
                             bool slips) const;

  /// The amplitude up to which it sticks; infinite of one that does not slip.
  virtual double slip_threshold(double load) const;

 protected:
  /// How `linear`, `conjugate` and `by_log_load`, which are zero before, of a force that is not linear
  /// change.
  virtual void second(const ElementForce& at, std::span<const int> orders, const HarmonicVector& x,
                      double load, const HarmonicVector& motion, double log_load,
                      ElementForce& change) const = 0;
};

}  // namespace arcslip
