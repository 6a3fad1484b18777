#pragma once

// Numbers of a system that may be continued beside eta and the preload, each by how it changes base, damper
// and contacts: closed, since every one scales a whole matrix or the load.
//
//   F             the load
//   zeta_B        the base's damping ratio,   zeta_D   the damper's
//   K_FD          all contacts' stiffness, at the same limit of their force
//   M*            mass_ratio: base mass, stiffness and load, at the same gamma
//   gamma         frequency_ratio: base stiffness and load
//   cubic_stiffness   of the base's springs to ground
//   P_2           growth of the preload P + P_2 eta^2
//   L             all contacts' limit_per_preload
//   K_FD_2, L_2   of the second of several contacts; so of each
//   influence     all that a flow does to the base
//   stops.gap     a setting of an element, see setting_name
//   speed         of rotation, in revolutions, of sectors that feel it
//
// M*, gamma and cubic_stiffness belong to rods and beams; of the load goes F K*, of the contacts' slip P
// K*/K_FD. L and what is of one contact belong to sectors, of which K_FD is N k of the first contact and
// K_FD_2 of the second.

#include <functional>
#include <string>
#include <vector>

#include "arcslip/setting.hpp"
#include "arcslip/structure/contact_modes.hpp"

namespace arcslip {

struct SystemParameters;

/// What a value of a parameter does to the system, or the rates at which it does.
struct SystemVariation {
  Variation base;                ///< of the base
  Variation damper;              ///< of the damper
  double contact_stiffness = 1;  ///< factor on k of the contacts that are concerned
  double slip_per_preload = 1;   ///< factor on S/P of the same
  double others = 1;             ///< factor on the forces of cubic springs, which are told relative to K*
  double preload_growth = 0;     ///< P_2
  double base_viscous = 1;       ///< factor on the base's viscous loss per zeta_B
};

/// One of these numbers.
struct SystemParameter {
  /// At a value, with rates.
  struct At {
    SystemVariation here;  ///< what the value does
    SystemVariation rate;  ///< its derivatives
  };

  /// What it is a number of.
  enum class Kind {
    load,     ///< scales it, and does nothing else
    damping,  ///< a damping ratio
    contact,  ///< a stiffness or a limit of contacts
    growth,   ///< of the preload, with eta^2
    flow,     ///< what a flow does
    element,  ///< a setting of an element beside the contacts
    speed,    ///< of rotation
    ratio     ///< of base to damper, which sectors do not have
  };

  std::string name;                                      ///< what case files call it
  double value;                                          ///< that of the system
  std::function<At(double value)> at;                    ///< closed
  Kind kind;                                             ///< what it is a number of
  std::function<SystemParameters(double value)> system;  ///< with another value
  Index contact = -1;                                    ///< the one that it concerns; of all contacts -1
  Setting limits = {};                                   ///< of one of an element: what it may be

  /// Whether a contact is concerned.
  bool concerns(Index one) const { return contact < 0 || contact == one; }

  /// A typical magnitude of it, > 0, where it has this value at a preload and a frequency.
  double scale(double other, double preload, double eta) const;

  /// Whether a system may have this value.
  bool allows(double other) const {
    if (kind == Kind::element)
      return other <= limits.high && (limits.may_be_low ? other >= limits.low : other > limits.low);
    return kind == Kind::damping || kind == Kind::growth || kind == Kind::flow || kind == Kind::speed ||
           other > 0;
  }
};

/// The names of those that are not of a part, in the order in which they are told.
std::vector<std::string> system_parameter_names();

/// Those of a system.
std::vector<SystemParameter> system_parameters(const SystemParameters& system);

/// Their names.
std::vector<std::string> system_parameter_names(const SystemParameters& system);

/// The system with another value of a parameter.
SystemParameters with_parameter(const SystemParameters& system, const std::string& name, double value);

/// That of a name for a system. Throws std::invalid_argument where the system has none of this name.
SystemParameter system_parameter(const SystemParameters& system, const std::string& name);

}  // namespace arcslip
