#pragma once

// What acts along one or several coordinates of the interface: forces that follow from the motion x(t) of
// these coordinates over a period and from the load that presses the parts together, f = f(x; load), in
// several harmonics. Their orders begin with 1; unless all are odd, 0 and even ones follow, the mean as a
// coefficient without imaginary part. Vectors of harmonics hold all those of the first coordinate, then those
// of the next.

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "arcslip/elements/disturbed_law.hpp"
#include "arcslip/elements/jet.hpp"
#include "arcslip/elements/piecewise_law.hpp"
#include "arcslip/elements/slip_count.hpp"
#include "arcslip/elements/varying_stiffness.hpp"
#include "arcslip/motion/swing.hpp"

namespace arcslip {

struct LineForce;
class TwoPhases;

/// The force of an element, with its derivatives: df_h = sum_l linear(h, l) dx_l + conjugate(h, l)
/// conj(dx_l), of which for l = 0 each is half of the derivative.
struct ElementForce {
  HarmonicVector harmonics;      ///< f_h, against x
  HarmonicVector by_log_load;    ///< df_h/d ln(load)
  HarmonicVector by_setting;     ///< df_h by a setting of the element that is continued; empty if none is
  HarmonicVector by_eta = {};    ///< df_h/deta of what is viscous; empty if nothing is
  ComplexMatrix linear;          ///< harmonics of all coordinates, squared
  ComplexMatrix conjugate;       ///< the same
  double energy = 0;             ///< lost per cycle
  Swing swing{};                 ///< of the motion of one coordinate, where the force was found from it
  FurtherSlips further_slips{};  ///< of what slips

  /// k x, whatever the load is.
  void set_linear(double stiffness, const HarmonicVector& x, bool derivatives);

  /// By a factor on the force.
  void scale(double factor, bool derivatives);

  /// A force c dx/dt in time t, of which a period is p/eta; one coordinate.
  struct Viscous {
    Jet damping;                  ///< c
    double eta;                   ///< frequency of the harmonic p
    int periods;                  ///< p
    std::span<const int> orders;  ///< h
  };

  /// Adds it, under the motion x.
  void add(const Viscous& viscous, const HarmonicVector& x, bool derivatives);

  /// Adds to the change of a force what is viscous does to derivatives, as x, eta and the setting change.
  void add_change(const Viscous& viscous, const HarmonicVector& x, const HarmonicVector& dx, double deta,
                  double setting);

  /// Adds so much of a change.
  void add(const ElementForce& change, double part);

  /// Adds the rate at which the derivatives change between one step back and one ahead, but `by_eta`.
  void add_rate(const ElementForce& ahead, const ElementForce& behind, double step);
};

/// E = pi sum_h h Im(f_h conj(x_h)) of a force under a motion: lost per cycle.
double cycle_energy(std::span<const int> orders, const Eigen::Ref<const ComplexVector>& force,
                    const Eigen::Ref<const ComplexVector>& x);

/// A number that follows from a motion.
struct MotionNumber {
  double value;
  HarmonicVector by_motion;  ///< derivatives by Re x_h and Im x_h as real and imaginary part
  double by_log_load;        ///< by ln(load)
  double by_setting;         ///< by a setting of the element that is continued
};

/// Bounds of the mean force along an element's first coordinate as it sticks for ever.
struct RestingForce {
  double least;     ///< where its slider rests farthest forwards
  double greatest;  ///< and backwards
};

/// What an element tells beside its force.
struct Reading {
  std::string name;       ///< as "slip"
  bool is_force = false;  ///< whether a factor on the element's force is one on it
};

/// Immutable, and used from all threads.
class Element {
 public:
  virtual ~Element() = default;

  /// In how many coordinates it acts.
  virtual Index coordinates() const { return 1; }

  /// The stiffness, > 0, relative to which the force in one of them is measured: that of the stuck state, if
  /// there is one.
  virtual double reference_stiffness(Index coordinate = 0) const = 0;

  /// Whether it takes even orders and 0, and whether an odd motion meets an odd force.
  virtual bool takes_any_orders() const { return true; }
  virtual bool is_odd() const { return true; }

  /// What it tells of a period beside its force, as "T_max", the greatest tangential force, or "slip", the
  /// part of it in which it slips, and their values under a motion with, if they are wanted, derivatives.
  virtual std::vector<Reading> readings() const { return {}; }
  virtual std::vector<MotionNumber> read(std::span<const int> /*orders*/, const HarmonicVector& /*x*/,
                                         double /*load*/, bool /*beyond*/, bool /*derivatives*/) const {
    return {};
  }

  /// Whether its first state is that of a slider that may rest at other places as well, and between which
  /// forces it then does under a motion without drift; none of one that slides along two coordinates.
  virtual bool may_rest() const { return false; }
  virtual std::optional<RestingForce> resting_force(std::span<const int> /*orders*/,
                                                    const HarmonicVector& /*x*/, double /*load*/) const {
    return {};
  }

  /// Whether a cycle may take energy.
  virtual bool dissipates() const { return false; }

  /// What may begin or end within a period of motions with these orders: where along a branch it does, a
  /// function of the motion changes its sign, which the force beyond the border tells or else `event`.
  virtual std::vector<ElementEvent> events(std::span<const int> /*orders*/) const { return {}; }
  virtual double event(Index which, std::span<const int> orders, const HarmonicVector& x, double load) const;

  /// Whether it has a second state beyond a border, as a contact that slips; else its force is smooth.
  virtual bool has_border() const { return false; }

  /// Whether it is in its second state at rest.
  virtual bool rests_beyond(double /*load*/) const { return false; }

  /// What it does in its second state, as "slip".
  virtual std::string beyond() const { return ""; }

  /// Whether the force is reference_stiffness() x in this state under odd motions and, where the state is the
  /// first one, under small ones.
  virtual bool is_linear(bool /*beyond*/) const { return false; }

  /// The force under the motion x with these orders; all but harmonics, energy and, beyond, the
  /// swing only with `derivatives`. No motion beyond the border is zero. Of odd orders it allocates nothing
  /// where the sizes are those of before.
  virtual void force(std::span<const int> orders, const HarmonicVector& x, double load, bool beyond,
                     bool derivatives, ElementForce& out) const = 0;

  /// Gives the force under a motion with two frequencies of the ratio s/w, of one coordinate, if they are
  /// wanted with its derivatives; false of an element that cannot.
  [[nodiscard]] virtual bool in_two_phases(const TwoPhases& /*phases*/, double /*load*/,
                                           const ComplexVector& /*x*/, double /*ratio*/, bool /*derivatives*/,
                                           LineForce& /*out*/) const {
    return false;
  }

  /// c of a force c dx/dt that acts beside the one that `force` gives, of one coordinate.
  virtual Jet damping() const { return 0; }

  /// A way in which x, ln(load) and a setting that is continued change.
  struct Way {
    HarmonicVector motion;  ///< rate of x
    double log_load = 0;    ///< of ln(load)
    double setting = 0;     ///< of the setting

    /// The fastest of these, relative to x, 1 and the setting's scale.
    double pace(const HarmonicVector& x, double setting_scale) const;
  };

  /// How harmonics and derivatives, which `force` has given as `at` with these arguments, change along it. Of
  /// the energy and the maximum nothing is said.
  ElementForce change(const ElementForce& at, std::span<const int> orders, const HarmonicVector& x,
                      double load, bool beyond, const Way& way) const;

  /// Whether `disturbed` tells what disturbances of odd motions meet, as it has a memory in every state or a
  /// force that follows from the velocity.
  virtual bool is_told_by_law() const { return false; }

  /// What small disturbances of the motion x meet in this state, over a turn: a whole period or, of odd
  /// orders, half of one. A contact of odd motions is told by hysteresis_loop.hpp. Throws std::logic_error
  /// unless overridden.
  virtual DisturbedLaw disturbed(std::span<const int> orders, const HarmonicVector& x, double load,
                                 bool beyond) const;

  /// What small disturbances of the motion x meet; a contact that slips has a memory and no such stiffness.
  /// Throws std::logic_error unless overridden: what has a memory in every state has none.
  virtual VaryingStiffness stiffness_in_time(std::span<const int> orders, const HarmonicVector& x) const;

  /// The border of one that has one, of one coordinate (A^2 - S^2)/(A^2 + S^2) = tanh ln(A/S) in the first
  /// state and its negative beyond, smooth where the motion is zero. A is max |x| or, of one that forgets the
  /// mean, half of the motion's range; `known` is its swing, if it is.
  virtual MotionNumber border(std::span<const int> orders, const HarmonicVector& x, const Swing* known,
                              double load, bool beyond) const;

  /// Whether its border is reached by how far the motion goes from side to side, wherever its middle is.
  virtual bool forgets_mean() const { return false; }

  /// Whether in this state the force depends on the mean of the motion in a coordinate.
  virtual bool holds_mean(Index /*coordinate*/, bool /*beyond*/) const { return true; }

  /// The same element where nothing else holds the mean of its first coordinate: its border is reached from
  /// the middle, and beyond it that coordinate drifts, x = v theta + sum_h x_h e^{jh theta}, with v as the
  /// imaginary part of x_0. Null of one that cannot tell its force then.
  virtual std::shared_ptr<const Element> alone() const { return nullptr; }

  /// S, the amplitude up to which it stays in its first state; infinite of one without border.
  virtual double threshold(double load) const;

  /// d ln S/d ln(load).
  virtual double threshold_by_log_load() const { return 0; }

  /// d ln S by a setting that is continued.
  virtual double log_threshold_by_setting() const { return 0; }

  /// The law of one without memory, as its motion in time follows it; null of others.
  virtual const PiecewiseLaw* law() const { return nullptr; }

 protected:
  /// The force with derivatives under another motion, with so much added to ln(load) and to the setting.
  using Moved =
      std::function<void(const HarmonicVector& x, double log_load, double setting, ElementForce& out)>;

  /// Over which forces of smooth pieces are differenced, of the motion.
  static constexpr double smooth_step = 1e-5;

  /// `second` by central differences over `relative` times the motion, or the setting over its scale.
  static void difference(const Moved& moved, const HarmonicVector& x, const Way& way, double setting_scale,
                         double relative, ElementForce& change);

  /// How `linear`, `conjugate`, `by_log_load` and `by_setting`, which are zero before, of a force that is not
  /// linear change.
  virtual void second(const ElementForce& at, std::span<const int> orders, const HarmonicVector& x,
                      double load, bool beyond, const Way& way, ElementForce& change) const = 0;
};

}  // namespace arcslip
