#pragma once

// The two structures of the paper and their interface: what a case file's [system] describes, and the reduced
// model built from it.

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "arcslip/assembly/excitation.hpp"
#include "arcslip/assembly/influence.hpp"
#include "arcslip/elements/element_kind.hpp"
#include "arcslip/structure/contact_modes.hpp"
#include "arcslip/structure/rotation.hpp"

namespace arcslip {

class Structures;

/// What base and damper are made of, unless `structures` says it.
enum class StructureModel { rods, beams };

/// As case files have it: its name.
std::string to_string(StructureModel model);

/// How a structure dissipates: viscous, C_B = (2 zeta_B/gamma)/(2 pi) K_B [paper, footnote 3], or structural
/// with the stiffness K_B (1 + 2 j zeta_B) at every eta. Both have the loss factor 2 zeta_B at eta = gamma.
/// Modal, of sectors only: every mode has the damping ratio zeta.
enum class DampingKind { viscous, structural, modal };

/// As case files have it: its name.
std::string to_string(DampingKind kind);

/// An element beside the contacts, at the same place of each node.
struct PlacedElement {
  /// Where it acts.
  enum class Place {
    contact,  ///< between base and damper
    base,     ///< between the base and ground
    damper    ///< between the damper and ground
  };

  std::string name = {};  ///< under which its settings are continued; of its kind and number if it has none
  const ElementKind* kind = nullptr;            ///< what it is
  Place place = Place::base;                    ///< where it acts
  Index dof = 0;                                ///< which of the contact dofs, from 0
  std::vector<double> settings;                 ///< forces of rods and beams N times those of a node
  std::shared_ptr<const ElementKind> own = {};  ///< keeps a kind alive that is none of element_kinds()
  Index second = 0;                             ///< of one that slides along two, the other contact dof
  Index normal = -1;              ///< of one that also closes, the contact dof along which it does; else -1
  bool closes_backwards = false;  ///< whether it closes where that one's coordinate, or of a one-sided
                                  ///< element its own, is negative

  bool closes() const { return normal >= 0; }                              ///< whether it does
  bool is_odd() const { return kind->is_odd && !closes(); }                ///< as its kind tells
  Index coordinates() const { return kind->slides + (closes() ? 1 : 0); }  ///< in how many it acts
};

/// A motion that is wanted beside those of the contacts, a sum over dofs of one structure times weights.
struct WantedOutput {
  std::string name;     ///< the column's, behind Y_ or U_
  bool on_base = true;  ///< or of the damper
  Vector weights = {};  ///< of all dofs, as the kind of structure counts them
};

/// [system] of a case file, nondimensional throughout.
struct SystemParameters {
  StructureModel model = StructureModel::beams;  ///< of both
  Index wave_number = 1;                         ///< n >= 1
  Index elements = 30;                           ///< N > 2n
  double mass_ratio = 1;                         ///< M* = m_B/m_D > 0
  double frequency_ratio = 1;                    ///< gamma = sqrt(K*/M*) > 0
  double interface_stiffness = 1;                ///< K_FD = k_F/k_D > 0
  double base_damping = 1e-4;    ///< zeta_B, negative where the base is excited by its own motion
  double damper_damping = 1e-4;  ///< zeta_D
  double force = 1;              ///< F = f_0/k_B > 0
  double preload = 1;            ///< P = mu p_0/k_B > 0

  DampingKind base_damping_kind = DampingKind::viscous;  ///< of rods and beams
  bool fixed_damper = false;   ///< the damper is held: c_D = 0, an interface to ground
  double cubic_stiffness = 0;  ///< of springs from the base's nodes to ground: N k_3/K*
  double preload_growth = 0;   ///< P_2 of the preload P + P_2 eta^2, which grows with the speed of rotation
  bool one_way = false;        ///< friction acts on the damper and not back on the base
  /// h in which friction is balanced, in parts of the load's frequency: that in which it acts first, p if the
  /// response repeats itself after p of its periods, then ascending.
  std::vector<int> harmonics = {1};
  Index subharmonic_wave = 0;  ///< m, if p > 1: on how many waves the harmonic 1 travels, p m = n modulo N
  std::vector<PlacedElement> others = {};  ///< beside contacts and cubic springs
  std::vector<WantedOutput> wanted = {};   ///< of rods and beams the dofs of an element, else the masses
  Excitation excitation = {};              ///< the load's harmonics, of which the balanced ones act

  std::shared_ptr<const Influence> influence = {};  ///< of a flow on the base; null: none
  double influence_factor = 1;                      ///< on all of it

  std::string varied = {};  ///< a parameter of system_parameter.hpp that may be continued
  bool tells_lag = false;   ///< whether the lag of the motion that the load does work on is wanted

  /// Base and damper, if they are no rods or beams: then n may be 0, N = `elements` is the number of sectors,
  /// K_FD = N k of the first contact, and no ratio, cubic stiffness or fixed damper counts.
  std::shared_ptr<const Structures> structures = {};
  std::vector<SectorContact> contacts = {};  ///< theirs, one or several
  double eta_low = 0;                        ///< window of eta in which they must give the response
  double eta_high = 0;
  Rotation rotation = {};     ///< with which they turn, nodes numbered along it where the speed is above 0
  double preload_speed2 = 0;  ///< the part of P_2 that is told as of P + P_2 speed^2, beside an engine order
  double speed_low = 0;       ///< window of the speed where it is continued
  double speed_high = 0;

  /// p.
  int periods() const { return harmonics.front(); }

  /// On how many waves the harmonic 1 travels.
  Index first_wave() const { return periods() == 1 ? wave_number : subharmonic_wave; }

  /// What the load in the harmonic h of the response is turned by against a real one.
  Complex load_turn(int h) const { return h % periods() == 0 ? excitation.turn(h / periods()) : 1; }

  /// Whether the speed is not, or may be as it is continued not, zero.
  bool turns() const { return !rotation.is_none() || varied == "speed"; }

  /// Whether elements act beside the contacts.
  bool has_others() const { return has_cubic_springs() || !others.empty(); }

  /// Whether there are, or may be as it is continued, cubic springs.
  bool has_cubic_springs() const { return cubic_stiffness != 0 || varied == "cubic_stiffness"; }

  double stiffness_ratio() const { return frequency_ratio * frequency_ratio * mass_ratio; }  ///< K*
};

/// The name of the i-th element beside contacts and cubic springs: "stops" if it is given, else "clearance"
/// of the first of its kind, "clearance_2" of the second.
std::string element_name(const SystemParameters& parameters, std::size_t i);

/// What a setting of it is called as a parameter: "stops.gap".
std::string setting_name(const SystemParameters& parameters, std::size_t i, std::size_t setting);

/// 1, 3, ..., `highest`.
std::vector<int> odd_up_to(int highest);

/// The same with 0 and the even ones between: 1, 0, 2, 3, ...
std::vector<int> all_up_to(int highest);

/// The orders up to `highest`, or to p, that a response over p periods of the load takes, p first: all of
/// them or, of one that is odd, the odd ones.
std::vector<int> orders_up_to(int highest, int periods, bool odd);

/// Those of a system, as many as may be balanced: as its own orders are.
std::vector<int> orders_up_to(int highest, const SystemParameters& system);

/// On how many of `elements` nodes' waves m the harmonic 1 of a response over p periods of a load of n waves
/// may travel: all m with p m = n modulo N, ascending.
std::vector<Index> subharmonic_waves(Index wave_number, Index elements, int periods);

/// How many harmonics may be balanced.
int most_orders(const SystemParameters& system);

/// Whether an odd motion meets odd forces of all elements.
bool is_odd(const SystemParameters& system);

/// Whether elements have a friction coefficient of their own beside the load.
bool has_own_friction(const SystemParameters& system);

/// Shear estimate of the beams' interface stiffness, K_FD = 12 (L/h_D)^4/(1 + nu) [paper, footnote 4].
double shear_interface_stiffness(double slenderness, double poisson_ratio);

/// The same estimate for either model: k_F = G w_D L/(h_D/2) over k_D = E w_D h_D/L of rods is
/// (L/h_D)^2/(1 + nu).
double shear_interface_stiffness(StructureModel model, double slenderness, double poisson_ratio);

/// ln S with its derivatives.
struct LogThreshold {
  double value;       ///< ln S
  double by_eta;      ///< d ln S/deta
  double by_preload;  ///< d ln S/dP
};

/// Base, damper and interface at one contact point, as the response equation needs them.
struct FrictionSystem {
  ModalModel base;           ///< with the travelling load
  ModalModel damper;         ///< without load
  double contact_stiffness;  ///< k = K_FD/N [paper (7)]
  double slip_per_preload;   ///< S/P = K*/K_FD [paper (13)]

  Loss base_loss_per_zeta = {};             ///< the base's loss over zeta_B
  double cubic_stiffness = 0;               ///< k_3: force k_3 y^3 on each contact dof of the base
  double preload_growth = 0;                ///< P_2
  Loss base_loss_fixed = {};                ///< the rest of the base's loss
  std::vector<ContactOutput> outputs = {};  ///< further amplitudes that are wanted

  /// Whether the contact is closed: P > 0 and P + P_2 eta^2 > 0, by so much that a double holds S^2, of which
  /// energies are multiples.
  bool is_loaded(double eta, double preload) const {
    constexpr double smallest = 1.5e-154;
    return preload > 0 && slip_threshold(eta, preload) >= smallest;
  }

  /// S = (P + P_2 eta^2) K*/K_FD.
  double slip_threshold(double eta, double preload) const {
    return (preload + preload_growth * eta * eta) * slip_per_preload;
  }

  /// For a contact that is loaded.
  LogThreshold log_threshold(double eta, double preload) const {
    const double by_preload = 1 / (preload + preload_growth * eta * eta);
    return {std::log(slip_threshold(eta, preload)), 2 * preload_growth * eta * by_preload, by_preload};
  }
};

/// Damping factors beta of C = (beta/2 pi) K: 2 zeta_B/gamma and 2 zeta_D [paper, footnote 3].
double base_damping_factor(const SystemParameters& parameters);
double damper_damping_factor(const SystemParameters& parameters);

/// k_3 of each spring between the base's nodes and ground.
double cubic_coefficient(const SystemParameters& parameters);

/// The whole model; its cost does not depend on N.
FrictionSystem build_system(const SystemParameters& parameters);

}  // namespace arcslip
