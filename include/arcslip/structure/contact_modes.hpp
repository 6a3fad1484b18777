#pragma once

// A structure seen at several contact dofs, as a sum over its modes v_k:
//
//   C(eta) = E^T Z^{-1} E = sum_k s_k s_k^H/d_k,   y_0(eta) = E^T Z^{-1} F = sum_k s_k l_k/d_k,
//   s_k = E^T v_k/(2 pi),   l_k = v_k^H F/(2 pi),   d_k as in ModalModel
//
// E has a unit column for each contact. ModalModel is this for one contact. At rest, eta = 0, a rigid motion
// has no d_k: the sums are then over the modes that deform the structure.

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "arcslip/structure/modal_model.hpp"

namespace arcslip {

/// One entry for each contact, and one row and column.
using ContactVector = ComplexVector;
using ContactMatrix = ComplexMatrix;

/// Inverts in place, with partial pivoting. Allocates nothing for up to 32 rows, of which calls would cost
/// more than arithmetic.
void invert(ContactMatrix& a);

/// Response at m contacts for a given eta, with its derivatives in eta.
struct ContactReceptance {
  ContactMatrix compliance;  ///< C, m x m: motion of the contact of the row per force on that of the column
  ContactMatrix compliance_eta;  ///< dC/deta
  ContactVector free;            ///< y_0, m: the response without contact
  ContactVector free_eta;        ///< dy_0/deta

  /// Gives all of them this size, filled with zeros.
  void set_zero(Index contacts);
};

/// A structure whose properties are not those it was built with, or the rates at which they change.
struct Variation {
  double stiffness = 1;  ///< factor on K
  double mass = 1;       ///< factor on M
  double load = 1;       ///< factor on F
  Loss loss = {};        ///< in place of its own; proportional to these K and M
  double influence = 1;  ///< factor on what a flow does
  double speed = 0;  ///< added to that with which it turns, in revolutions, of what is solved for at speeds

  static Variation none() { return {0, 0, 0, {}, 0, 0}; }  ///< of rates
};

/// Response of such a structure, with its derivatives along the rates of a variation.
struct VariedReceptance : ContactReceptance {
  ContactMatrix compliance_rate;  ///< of C, m x m
  ContactVector free_rate;        ///< of y_0, m
};

/// Work of a cycle at eta: of the load, what the damping takes, and that of load and contact forces whatever
/// the phase between them and the motions they act on.
struct CycleWork {
  double load = 0;       ///< of the load
  double damping = 0;    ///< negative where it feeds energy in
  double magnitude = 0;  ///< without regard to phase
};

/// A structure's response at eta, and its work under given forces on its contacts, found in whatever way; may
/// be called from several threads.
using Receptance = std::function<ContactReceptance(double eta, double load)>;
using ReceptanceWork = std::function<CycleWork(double eta, double load, const ContactVector& forces)>;

/// The same with so many revolutions added to the speed with which it turns, by which the rates are.
using SpeedReceptance = std::function<VariedReceptance(double eta, double load, double speed)>;
using SpeedWork =
    std::function<CycleWork(double eta, double load, const ContactVector& forces, double speed)>;

/// One mode v_k as contacts and load see it.
struct ContactMode {
  double frequency;              ///< eta_k
  ContactVector shape;           ///< s_k, m
  Complex load;                  ///< l_k
  ModeInfluence influence = {};  ///< of a flow

  /// Whether it moves the structure without deforming it.
  bool is_rigid() const { return !(frequency > 0); }
};

/// The undamped modes of a structure that turns, at one speed or with a speed that follows eta:
///
///   C = sum_k s_k s_k^H/(1 - mu_k lambda),   lambda = eta^power
///
/// At one speed eta is that of a wave, or below zero that of the wave which runs the other way.
struct TurningModes {
  /// One of them.
  struct Mode {
    double inverse;       ///< mu_k, of any sign
    ContactVector shape;  ///< s_k
    Complex load;         ///< as of ContactMode
  };
  int power = 1;
  std::vector<Mode> modes;
  std::vector<double> frequencies;  ///< of the modes at rest
  ComplexMatrix motion;             ///< the motion of these in each

  /// Those with eta > 0 as sums over modes have them near their resonance.
  std::vector<ContactMode> resonances() const;
};

/// With so many revolutions added to the speed.
using ModesAtSpeed = std::function<std::shared_ptr<const TurningModes>(double speed)>;

/// Immutable; may be used from several threads.
class ContactModes {
 public:
  /// All shapes have `contacts` >= 1 entries. Throws std::invalid_argument where they do not.
  ContactModes(Index contacts, std::vector<ContactMode> modes, const Loss& loss);

  /// The same structure with its response by `receptance` under this factor of its load, whatever its
  /// damping: the modes, undamped, serve for its resonances alone. Without `work` of its own, none may be
  /// asked for.
  ContactModes solved_by(Receptance receptance, double load, ReceptanceWork work = {}) const;

  /// The same of one that turns, at any speed.
  ContactModes solved_at_speeds(SpeedReceptance receptance, double load, SpeedWork work = {}) const;

  /// With resonances that are those of the structure as it turns.
  ContactModes turning(ModesAtSpeed modes) const;

  /// These; null of one that is at rest.
  std::shared_ptr<const TurningModes> turning_modes() const { return turning_ ? turning_(speed_) : nullptr; }

  /// With the motion that the load does work on, F^H d, as that of a further contact after all others. Of
  /// modes alone: what is solved for has to be solved for anew.
  ContactModes with_driven_motion() const;

  /// The same under a load that is turned in phase by this factor of modulus 1.
  ContactModes turned(const Complex& turn) const;

  /// The same modes with another loss.
  ContactModes with(const Loss& loss) const { return {contacts_, modes_, loss}; }

  /// O(m^2) operations for each mode, or what `receptance` costs.
  ContactReceptance at(double eta) const;

  /// Adds what `at` gives to `sum`, of this size.
  void add(double eta, ContactReceptance& sum) const;

  /// pi Im(F^H d)* and pi d^H Im Z d of the motion d under load and forces; the magnitude is the sum of those
  /// of all modes, or where it is solved otherwise of load and contacts, |F^H d| and |f_i y_i|.
  CycleWork work(double eta, const ContactVector& forces) const;

  /// The response of the modes as their structure is varied,
  ///   C = sum_k s_k s_k^H/(m d_k)   with eta_k sqrt(a/m) in d_k   for factors a on K and m on M.
  /// One that is solved for may differ in its load and its speed alone.
  VariedReceptance varied(double eta, const Variation& at, const Variation& rate) const;

  /// The structure as it is varied. One that is solved for may differ in its load and its speed alone.
  ContactModes varied(const Variation& at) const;

  /// What it was made of.
  Index contacts() const { return contacts_; }
  const std::vector<ContactMode>& modes() const { return modes_; }
  const Loss& loss() const { return loss_; }
  bool is_solved() const {
    return receptance_ != nullptr;
  }  ///< whether its response is not that of the modes

 private:
  void add_many(double eta, ContactReceptance& sum) const;

  Index contacts_;
  std::vector<ContactMode> modes_;
  ComplexMatrix shapes_;  // of the modes, contacts x modes, where there are many contacts
  Loss loss_;
  SpeedReceptance receptance_;  // in place of the sum, if there is one
  SpeedWork receptance_work_;
  double receptance_load_ = 1;
  ModesAtSpeed turning_;
  double speed_ = 0;  // added to that of both
};

/// One contact dof of each sector.
struct SectorContact {
  double stiffness = 1;         ///< k > 0, or 0 where nothing rubs and S/P is `never_slips`
  double slip_per_preload = 1;  ///< S/P > 0
};

/// k of each contact.
Vector contact_springs(const std::vector<SectorContact>& contacts);

/// A further dof of base or damper whose amplitude is wanted: one of theirs seen as a contact after all
/// others.
struct ContactOutput {
  std::string name;     ///< the column's
  ContactModes modes;   ///< of its structure, the output as its last contact
  bool on_base;         ///< or on the damper
  bool is_lag = false;  ///< its lag behind the load is wanted in place of its amplitude

  /// Under the load and the forces on the contact dofs of its structure.
  Complex motion(double eta, const ContactVector& forces) const;
  /// Of the motion.
  double amplitude(double eta, const ContactVector& forces) const { return std::abs(motion(eta, forces)); }
};

/// That of the motion that the load does work on, of a base with it: its lag behind the load.
ContactOutput driven_motion(ContactModes base);

/// Base, damper and the interface between their contacts.
struct ContactSystem {
  ContactModes base;                        ///< with the travelling load
  ContactModes damper;                      ///< without load
  std::vector<SectorContact> contacts;      ///< in the order of the structures' own
  std::vector<ContactOutput> outputs = {};  ///< further amplitudes that are wanted
};

/// A mode of several structures on springs.
struct JoinedMode {
  double frequency;        ///< eta_k
  double damping;          ///< damping ratio, to the first order in the losses
  ContactVector relative;  ///< displacements of the springs, as of contacts relative ones, of any size
  ComplexVector motion;    ///< of the modes of the structures, one structure after the other
};

/// The undamped modes of `structures`, all of them at rest or all turning in one way, joined at their
/// contacts through springs, of stiffness `springs` (m); of one structure, joined to ground. Relative to the
/// first structure the others move backwards. In ascending order.
std::vector<JoinedMode> joined_modes(const std::vector<const ContactModes*>& structures,
                                     const Vector& springs);

/// The same on springs anywhere: `moved` tells by how much they are displaced as the contacts of the first
/// structure or of another one are.
using MovedSprings = std::function<ContactVector(const ContactVector& shape, bool is_first)>;
std::vector<JoinedMode> joined_modes(const std::vector<const ContactModes*>& structures,
                                     const Vector& springs, const MovedSprings& moved);

}  // namespace arcslip
