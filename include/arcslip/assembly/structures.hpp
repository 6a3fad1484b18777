#pragma once

// The seam behind which base and damper stand: what they are made of is known to one class, the rest of the
// program asks for their response under a travelling wave. Rods and beams are `Rings` of the system's own
// numbers; others are held by SystemParameters::structures. What case files say of them is a StructureKind.

#include <memory>
#include <string>
#include <vector>

#include "arcslip/assembly/system.hpp"
#include "arcslip/assembly/system_parameter.hpp"

namespace arcslip {

/// How damping goes with zeta_B and zeta_D.
struct PairLosses {
  Loss base_per_zeta = {};    ///< of the base, over zeta_B
  Loss base_fixed = {};       ///< what is there besides
  Loss damper_per_zeta = {};  ///< of the damper, over zeta_D
  Loss damper_fixed = {};     ///< and its rest

  /// The whole loss at a system's damping ratios.
  Loss base(const SystemParameters& system) const { return base_fixed + system.base_damping * base_per_zeta; }
  Loss damper(const SystemParameters& system) const {
    return damper_fixed + system.damper_damping * damper_per_zeta;
  }
};

/// How well the modes that stand for a part were found.
struct PartModes {
  std::string part;        ///< "base" or "damper"
  Index dofs;              ///< that it has
  Index modes;             ///< that stand for it
  int factorisations;      ///< it took
  bool is_solved = false;  ///< its equations are solved at each eta, and its modes only show the resonances
  double error = 0;        ///< of its response, relative, at worst
  double error_eta = 0;    ///< where that is
  std::vector<double> check_etas = {};  ///< where it was compared
  double tolerance = 0;                 ///< that was asked for
};

class WholeRing;

/// Base and damper. Immutable but for what is found once and kept; used from several threads.
class Structures {
 public:
  virtual ~Structures() = default;

  /// Both under the wave of `system`, loaded, with its contacts, outputs and lag. Throws
  /// std::invalid_argument.
  virtual ContactSystem wave(const SystemParameters& system) const = 0;

  /// Base or damper under the same wave as its contacts see it and, after them, all of its outputs that
  /// `wave` has, in their order, as further contacts. Throws std::invalid_argument where it has outputs and
  /// is no sum of modes.
  virtual ContactModes seen(const SystemParameters& system, bool is_base) const;

  /// What it is if its contacts are those of all sectors; else null.
  virtual const WholeRing* whole() const { return nullptr; }

  /// The same with a single contact and modes alone, as the response of one unknown takes it; by default made
  /// of `wave`. Throws std::invalid_argument.
  virtual FrictionSystem one_contact(const SystemParameters& system) const;
  /// Whether it can be made; by default where there is one contact.
  virtual bool is_one_contact(const SystemParameters& system) const { return system.contacts.size() == 1; }

  /// Over the damping ratios.
  virtual PairLosses losses(const SystemParameters& system) const = 0;

  /// The number of nodes whose forces together are what case files call a force.
  virtual double nodes(const SystemParameters& /*system*/) const { return 1; }

  /// w over eta, in the time that its masses are given in.
  virtual double circular_frequency() const { return two_pi; }

  /// Numbers of its own that may be continued, beside those of all systems.
  virtual std::vector<SystemParameter> parameters(const SystemParameters& /*system*/) const { return {}; }

  /// Refuses what cannot move as so many waves round so many nodes. Throws std::invalid_argument.
  virtual void check(Index /*wave_number*/, Index /*nodes*/) const {}

  /// The same by modes, which disturbances need; null where it is so already. Throws std::invalid_argument
  /// where there are none.
  virtual std::shared_ptr<const Structures> in_modes() const { return nullptr; }

  /// Whether equations of motion are behind it, which work, lag and motion in time are told by, and not its
  /// response alone.
  virtual bool has_equations() const { return true; }

  /// Whether rotation changes it.
  virtual bool feels_rotation() const { return false; }

  /// How its modes were found, part by part; nothing of what is exact.
  virtual std::vector<PartModes> modes(const SystemParameters& /*system*/) const { return {}; }
};

/// Those of a system: its own, or rods and beams.
const Structures& structures_of(const SystemParameters& system);

/// Whether they turn and are changed by it.
inline bool feels_rotation(const SystemParameters& system) {
  return system.turns() && structures_of(system).feels_rotation();
}

}  // namespace arcslip
