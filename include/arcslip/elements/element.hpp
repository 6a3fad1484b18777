#pragma once

// What acts along one coordinate of the interface: a force that follows from the coordinate's motion x(t)
// over a period and from the load that presses the parts together, f = f(x; load), in several odd harmonics.

#include <span>
#include <string>

#include "arcslip/elements/piecewise_law.hpp"
#include "arcslip/elements/varying_stiffness.hpp"
#include "arcslip/motion/odd_motion.hpp"

namespace arcslip {

/// The force of an element, with its derivatives: df_h = sum_l linear(h, l) dx_l + conjugate(h, l)
/// conj(dx_l).
struct ElementForce {
  HarmonicVector harmonics;      ///< f_h, against x
  HarmonicVector by_log_load;    ///< df_h/d ln(load)
  HarmonicVector by_setting;     ///< df_h by a setting of the element that is continued; empty if none is
  ComplexMatrix linear;          ///< harmonics x harmonics
  ComplexMatrix conjugate;       ///< the same
  double energy = 0;             ///< lost per cycle
  OddMotion::Maximum maximum{};  ///< of the motion, where the force was found from it

  /// k x, whatever the load is.
  void set_linear(double stiffness, const HarmonicVector& x, bool derivatives);

  /// By a factor on the force.
  void scale(double factor, bool derivatives);

  /// Adds so much of a change.
  void add(const ElementForce& change, double part);
};

/// Where a state of an element ends.
struct StateBorder {
  double value;              ///< negative inside
  HarmonicVector by_motion;  ///< derivatives by Re x_h and Im x_h as real and imaginary part
  double by_log_load;        ///< by ln(load)
  double by_setting;         ///< by a setting of the element that is continued
};

/// Immutable, and used from all threads.
class Element {
 public:
  virtual ~Element() = default;

  /// The stiffness, > 0, relative to which the force is measured: that of the stuck state, if there is one.
  virtual double reference_stiffness() const = 0;

  /// Whether it has a second state beyond a border, as a contact that slips; else its force is smooth.
  virtual bool has_border() const { return false; }

  /// What it does in its second state, as "slip".
  virtual std::string beyond() const { return ""; }

  /// Whether the force is reference_stiffness() x in this state.
  virtual bool is_linear(bool beyond) const = 0;

  /// The force under the motion x with these orders; all but harmonics, energy and, beyond, the maximum only
  /// with `derivatives`. No motion beyond the border is zero. Allocates nothing where the sizes are those of
  /// before.
  virtual void force(std::span<const int> orders, const HarmonicVector& x, double load, bool beyond,
                     bool derivatives, ElementForce& out) const = 0;

  /// A way in which x, ln(load) and a setting that is continued change.
  struct Way {
    HarmonicVector motion;  ///< rate of x
    double log_load = 0;    ///< of ln(load)
    double setting = 0;     ///< of the setting
  };

  /// How harmonics and derivatives, which `force` has given as `at` with these arguments, change along it. Of
  /// the energy and the maximum nothing is said.
  ElementForce change(const ElementForce& at, std::span<const int> orders, const HarmonicVector& x,
                      double load, bool beyond, const Way& way) const;

  /// What small disturbances of the motion x meet; a contact that slips has a memory and no such stiffness.
  virtual VaryingStiffness stiffness_in_time(std::span<const int> orders, const HarmonicVector& x) const = 0;

  /// The border of one that has one, (A^2 - S^2)/(A^2 + S^2) = tanh ln(A/S) in the first state and its
  /// negative beyond, smooth where the motion is zero; `top` is the motion's maximum.
  StateBorder border(std::span<const int> orders, const OddMotion::Maximum& top, double load,
                     bool beyond) const;

  /// S, the amplitude up to which it stays in its first state; infinite of one without border.
  virtual double threshold(double load) const;

  /// d ln S/d ln(load).
  virtual double threshold_by_log_load() const { return 0; }

  /// d ln S by a setting that is continued.
  virtual double log_threshold_by_setting() const { return 0; }

  /// The law of one without memory, as its motion in time follows it; null of others.
  virtual const PiecewiseLaw* law() const { return nullptr; }

 protected:
  /// How `linear`, `conjugate`, `by_log_load` and `by_setting`, which are zero before, of a force that is not
  /// linear change.
  virtual void second(const ElementForce& at, std::span<const int> orders, const HarmonicVector& x,
                      double load, bool beyond, const Way& way, ElementForce& change) const = 0;
};

}  // namespace arcslip
