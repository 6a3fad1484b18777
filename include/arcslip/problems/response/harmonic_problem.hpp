#pragma once

// What the problems of base, damper and contacts in several harmonics share: the coordinates x in which
// elements act, the regimes, which elements are beyond their border, as contacts that slip, and the
// quantities of their motions. Whether eta, a damping ratio or the first harmonic of the first coordinate is
// an unknown or a parameter is each problem's own matter, its layout.

#include "arcslip/assembly/coordinates.hpp"
#include "arcslip/assembly/harmonic_system.hpp"
#include "arcslip/assembly/rigid_motions.hpp"
#include "arcslip/continuation/path/trace.hpp"
#include "arcslip/continuation/problem/problem.hpp"
#include "arcslip/problems/response/slip_regimes.hpp"

namespace arcslip::problems {

/// Derive from it with a layout, and write what is to vanish.
class HarmonicProblem : public continuation::Problem {
 public:
  Index size() const override { return 2 * coordinates_.size() * harmonics(); }

  /// Of the elements that have a border, which come first.
  Index switch_count() const override { return coordinates_.switches(); }
  std::string describe(const continuation::Regime& regime) const override;
  int border_count(const continuation::Regime& /*regime*/) const override {
    return static_cast<int>(switch_count());
  }
  double border(const Vector& u, const Vector& p, const continuation::Regime& regime, int border,
                continuation::Gradient* gradient) const override;
  /// None where elements then slip that together, and none of them alone, hold the mean of what is free.
  std::optional<continuation::Regime> regime_beyond(const continuation::Regime& regime,
                                                    int border) const override;
  std::string reason_of_end() const override;

  /// The first border that a solution lies beyond, or -1.
  int crossed_border(const continuation::Guess& at) const;

  /// All but synthesised forces, and some of whole rings, have gradients.
  std::vector<continuation::Observable> observables() const override;
  void observe(const Vector& u, const Vector& p, const continuation::Regime& regime,
               Vector& values) const override;
  double observe(const Vector& u, const Vector& p, const continuation::Regime& regime, Index which,
                 continuation::Gradient& gradient) const override;

  /// Whether a part that friction alone holds drifts in a regime.
  bool drifts(const continuation::Regime& regime) const { return !drifting(regime).empty(); }

  /// What may begin or end within a period, of its elements: `lift_off_NAME`, `further_slip`. They refer to
  /// the problem.
  std::vector<continuation::UserEvent> events() const;

  /// How many contacts, coordinates and harmonics there are, and the system.
  Index contacts() const { return coordinates_.contacts(); }
  Index coordinates() const { return coordinates_.size(); }
  Index harmonics() const { return std::ssize(system_.orders); }
  const HarmonicSystem& system() const { return system_; }

  /// The elements, first those of the contacts, and whether elements alone hold the mean of some part.
  Index elements() const { return coordinates_.elements(); }
  const Element& element(Index e) const { return coordinates_.element(e); }
  bool is_free_to_move() const { return rigid_.count() > 0; }

  /// Between which mean forces an element that sticks for ever does so, which has such.
  RestingForce resting_force(Index element, const continuation::Guess& at) const {
    return coordinates_.element(element)
        .resting_force(system_.orders, element_motion(at.unknowns, at.parameters, element),
                       load(element, at.unknowns, at.parameters))
        .value();
  }

  /// x_h of a coordinate.
  HarmonicVector motion(const Vector& u, const Vector& p, Index coordinate) const;

  /// Those of all coordinates of an element, one after the other.
  HarmonicVector element_motion(const Vector& u, const Vector& p, Index element) const;

  /// S of a contact.
  double slip_threshold(Index contact, const Vector& u, const Vector& p) const {
    return coordinates_.element(contact).threshold(load(contact, u, p));
  }

 protected:
  /// Where one of the values that the motion depends on stands; one that stands nowhere does not vary.
  struct Place {
    /// Among which it is.
    enum Of { nowhere, unknowns, parameters } of = nowhere;
    Index index = 0;  ///< its position there
  };

  /// Re and Im of all harmonics of all coordinates are unknown, in the order of HarmonicResponse, but for
  /// the first two of them, in whose stead others may be.
  struct Layout {
    Place eta;             ///< the frequency
    Place preload;         ///< P
    Place real;            ///< Re x_1 of the first coordinate
    Place imaginary = {};  ///< and Im x_1, 0 where it stands nowhere
    Place damping = {};    ///< zeta of a damping -2 zeta w* M of both structures,
    bool of_base = false;  ///< or else zeta_B
    Place varied = {};     ///< the further parameter of the system, if it may be continued
  };

  /// Of what a quantity tells.
  enum class Measure {
    frequency,
    damping,
    threshold,
    ratio,
    amplitude,
    mean,
    lag,
    drift,
    dissipated,
    energy,
    greatest,
    force,
    reading,
    largest,
    amplification,
    least,
    wave,
    slipping,
    losses
  };
  /// Forces have none, and of a whole ring what may be zero.
  static bool has_gradient(Measure measure) {
    return measure != Measure::force && measure != Measure::least && measure != Measure::wave &&
           measure != Measure::slipping && measure != Measure::losses && measure != Measure::amplification;
  }
  enum class Body { contact, base, damper, output };
  struct Quantity {
    std::string name;         ///< the observable's
    Measure measure;          ///< what is told
    Body of = Body::contact;  ///< of what
    Index which = 0;          ///< contact or output; of an energy or a reading the element
    Index order = 0;          ///< the position of the harmonic, or which reading
    Index wave = 0;           ///< of motions round a whole ring, +-q
  };

  /// Throws std::invalid_argument where base, damper and contacts differ in number.
  HarmonicProblem(HarmonicSystem system, Layout layout);

  /// The quantities of the contacts but the first, of the first in the other harmonics, what an element tells
  /// and all those beside the contacts do, and how fast what elements alone hold drifts.
  void add_further_contacts();
  /// Of a whole ring, of the contacts of a sector and the outputs: the largest and least amplitudes of all
  /// sectors, the first contact's by waves, and the part of the contacts that slip.
  void add_ring();
  void add_other_harmonics();
  void add_readings(Index element, const std::string& suffix);
  void add_further_elements();
  void add_drifts();

  /// What a quantity is called in a harmonic: "Y_h3", over p = 2 periods of the load "Y_h3/2" in that of h
  /// = 3.
  std::string name_of(const std::string& quantity, Index order) const;

  /// What stands behind the names of what an element does: nothing of the first, "_contact_2", "_NAME".
  std::string suffix_of(Index element) const;

  /// What stands there; 0 of what stands nowhere.
  double value(const Place& place, const Vector& u, const Vector& p) const {
    return place.of == Place::unknowns ? u(place.index) : place.of == Place::parameters ? p(place.index) : 0;
  }
  /// eta.
  double frequency(const Vector& u, const Vector& p) const { return value(layout_.eta, u, p); }

  /// Whether none slips, whatever further elements do.
  bool contacts_stick(const continuation::Regime& regime) const;

  /// Which elements are in their second state at rest.
  continuation::Regime at_rest(const Vector& u, const Vector& p) const;

  /// Whether a further parameter of the system may be continued.
  bool is_varied() const { return layout_.varied.of != Place::nowhere; }

  /// Names with that of the further parameter after them, if there is one.
  std::vector<std::string> names_with_varied(std::vector<std::string> names) const {
    if (is_varied()) names.push_back(system_.varied->name);
    return names;
  }

  /// A typical magnitude of the further parameter.
  double varied_scale(const Vector& u, const Vector& p) const;

  /// What the further parameter does here.
  SystemParameter::At variation(const Vector& u, const Vector& p) const {
    return system_.varied->at(value(layout_.varied, u, p));
  }

  /// P_2.
  double growth(const Vector& u, const Vector& p) const {
    return is_varied() ? variation(u, p).here.preload_growth : system_.preload_growth;
  }

  /// P + P_2 eta^2.
  double pressing(const Vector& u, const Vector& p) const {
    const double eta = frequency(u, p);
    return value(layout_.preload, u, p) + growth(u, p) * eta * eta;
  }

  /// The same times what a variation does to S/P of a contact; of other elements it does not count.
  double load(Index element, const Vector& u, const Vector& p) const {
    return is_varied() && system_.varied->concerns(element)
               ? pressing(u, p) * variation(u, p).here.slip_per_preload
               : pressing(u, p);
  }

  /// How the logarithm of that load changes with the further parameter.
  double log_load_rate(Index element, const Vector& u, const Vector& p) const {
    const auto [here, rate] = variation(u, p);
    const double eta = frequency(u, p);
    const double by_growth = rate.preload_growth * eta * eta / pressing(u, p);
    return system_.varied->concerns(element) ? by_growth + rate.slip_per_preload / here.slip_per_preload
                                             : by_growth;
  }

  /// The first coordinate of an element.
  const Coordinate& first(Index element) const { return coordinates_[coordinates_.first(element)]; }

  /// Calls `use` with an element, as it is here.
  template <class Use>
  auto with_element(Index element, const Vector& u, const Vector& p, const Use& use) const {
    const auto& varied = first(element).varied;
    return is_varied() && varied ? use(*varied(value(layout_.varied, u, p)))
                                 : use(coordinates_.element(element));
  }

  /// The factor of a variation on the force of an element; null where it has none.
  double SystemVariation::*varied_force(Index element) const {
    if (element < contacts())
      return system_.varied->concerns(element) ? &SystemVariation::contact_stiffness : nullptr;
    return first(element).follows_base ? &SystemVariation::others : nullptr;
  }

  /// All factors on that force.
  double force_factor(Index element, const Vector& u, const Vector& p) const {
    const double own = first(element).factor;
    const auto varied = is_varied() ? varied_force(element) : nullptr;
    return varied != nullptr ? own * variation(u, p).here.*varied : own;
  }

  /// How the logarithm of that factor changes with the further parameter.
  double log_force_rate(Index element, const SystemParameter::At& at) const {
    const auto varied = varied_force(element);
    return varied != nullptr ? at.rate.*varied / at.here.*varied : 0;
  }

  /// The stiffness relative to which the force in a coordinate is measured.
  double reference_stiffness(Index coordinate, const Vector& u, const Vector& p) const {
    const Index element = coordinates_.element_of(coordinate);
    return coordinates_.element(element).reference_stiffness(coordinates_[coordinate].part) *
           force_factor(element, u, p);
  }

  /// What an element's force has beside what follows from its displacement, if there is any.
  std::optional<ElementForce::Viscous> viscous_of(const Element& element, const Vector& u,
                                                  const Vector& p) const;

  /// Where a harmonic of a coordinate stands in the vectors of its element's force.
  Index place(Index coordinate, Index order) const {
    return coordinates_[coordinate].part * harmonics() + order;
  }

  /// Of each element; valid until the thread's next call, whose work space it is.
  const std::vector<ElementForce>& forces(const Vector& u, const Vector& p,
                                          const continuation::Regime& regime, bool derivatives) const;

  /// A structure in one harmonic, with derivatives by eta itself and by the damping of the layout.
  struct Response : ContactReceptance {
    ContactMatrix by_damping;      ///< dC/dzeta
    ContactMatrix by_varied;       ///< dC by the further parameter
    ContactVector free_by_varied;  ///< dy_0 by it
  };
  /// `order` is the position of the harmonic.
  void respond(const ContactModes& structure, bool is_base, Index order, const Vector& u, const Vector& p,
               Response& response) const;

  /// The force whose response, synthesised from a mode, peaks here.
  virtual double synthesised_force(const Vector& u, const Vector& p,
                                   const continuation::Regime& regime) const;

  /// All coordinates at rest, where nothing is rigid: C_0 and -x0_0, with derivatives.
  struct Rest {
    ContactReceptance joint;       ///< C_0 and -x0_0
    ContactMatrix by_varied;       ///< of C_0 by the further parameter
    ContactVector free_by_varied;  ///< of -x0_0 by it
  };
  void respond_at_rest(const Vector& u, const Vector& p, Rest& rest) const;

  /// What rigid motions make of the coordinates' means under these forces: x_0 - x0_0 + C_0 f_0.
  ContactVector moved_at_rest(const Rest& rest, const std::vector<ElementForce>& elements, const Vector& u,
                              const Vector& p) const;

  /// A rigid motion that one element alone holds, and that goes on and on where this is beyond its border.
  struct Drift {
    Index element;         ///< which
    ComplexVector motion;  ///< alpha
    Vector ways;           ///< S alpha, real
  };

  /// Those that go on in a regime.
  std::vector<const Drift*> drifting(const continuation::Regime& regime) const;

  /// Onto these in the coordinates; of size 0 where nothing is free to move.
  Matrix onto_drifts(const continuation::Regime& regime) const;

  /// How coordinates drift in the place of rigid motions, coordinates x their number.
  ComplexMatrix drift_ways(const continuation::Regime& regime) const;

  /// How forces over stiffness change with rigid motions of the mean and, below, with drifts in their place,
  /// in all harmonics.
  ComplexMatrix changes_by_mean(const std::vector<ElementForce>& elements, const continuation::Regime& regime,
                                const Vector& u, const Vector& p) const;
  /// Whether with every rigid motion something of these changes: else the mean is anywhere, or nowhere.
  bool holds_mean(const ComplexMatrix& changes) const;

  HarmonicSystem system_;             ///< as it was given
  Coordinates coordinates_;           ///< of the system
  RigidMotions rigid_;                ///< of both
  std::vector<Drift> drifts_;         ///< of all regimes
  Layout layout_;                     ///< as it was given
  std::vector<Quantity> quantities_;  ///< the observables

 private:
  /// Forces of all elements with what they were found for, and what quantities are found by: work space of a
  /// thread.
  struct Forces {
    const HarmonicProblem* of = nullptr;
    std::vector<int> orders;
    Vector unknowns;
    Vector parameters;
    continuation::Regime regime;
    std::vector<ElementForce> of_elements;
    Response response;
    ContactVector on_structure;
  };
  static Forces& last_forces();
  void set_damping(bool is_base, const Vector& u, const Vector& p, Variation& here, Variation& by_varied,
                   Variation& by_damping) const;
  /// Where Re or Im of a harmonic stands, by its position among those of all.
  Place place_of(Index unknown) const;
  static void add(const Place& place, double value, continuation::Gradient& gradient);
  void add(const MotionNumber& number, Index element, const Vector& u, const Vector& p,
           continuation::Gradient& gradient) const;
  /// Adds what is `value` times a change of the logarithm of an element's load.
  void add_log_load(double value, Index element, const Vector& u, const Vector& p,
                    continuation::Gradient& gradient) const;
  const ElementForce& force_of(Index element, const Vector& u, const Vector& p,
                               const continuation::Regime& regime) const;
  const Swing* known_swing(const Vector& u, const Vector& p, Index element) const;
  ComplexMatrix loose(const continuation::Regime& regime, Index without = -1) const;
  void find_drifts();
  class Observation;
};

}  // namespace arcslip::problems
