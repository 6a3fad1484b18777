#pragma once

// Numbers of a system that may be continued beside eta and the preload, each by how it changes base, damper
// and contacts: closed, since every one scales a whole matrix or the load.
//
//   F             the load
//   zeta_B        the base's damping ratio,   zeta_D   the damper's
//   K_FD          all contacts' stiffness, at the same limit of their force
//   M*            mass_ratio: base mass, stiffness and load, at the same gamma
//   gamma         frequency_ratio: base stiffness and load
//
// The last two belong to rods and beams; of the load goes F K*, of the contacts' slip P K*/K_FD.

#include <functional>
#include <string>
#include <vector>

#include "arcslip/structure/contact_modes.hpp"

namespace arcslip {

struct SystemParameters;

/// What a value of a parameter does to the system, or the rates at which it does.
struct SystemVariation {
  Variation base;
  Variation damper;
  double contact_stiffness = 1;  ///< factor on k of every contact
  double slip_per_preload = 1;   ///< factor on S/P of every contact
  double others = 1;             ///< factor on the forces of cubic springs, which are told relative to K*
};

struct SystemParameter {
  /// At a value, with rates.
  struct At {
    SystemVariation here;
    SystemVariation rate;

    /// d ln(S/P).
    double log_slip_rate() const { return rate.slip_per_preload / here.slip_per_preload; }
  };

  enum class Kind {
    load,     ///< scales it, and does nothing else
    damping,  ///< a damping ratio
    contact,  ///< a stiffness of contacts
    ratio     ///< of base to damper, which sectors do not have
  };

  std::string name;
  double value;                        ///< that of the system
  std::function<At(double value)> at;  ///< closed
  Kind kind;

  /// Whether a system may have this value.
  bool allows(double other) const { return kind == Kind::damping || other > 0; }
};

/// The names of all, in the order in which they are told.
std::vector<std::string> system_parameter_names();

/// The system with another value of a parameter.
SystemParameters with_parameter(SystemParameters system, const std::string& name, double value);

/// That of a name for a system. Throws std::invalid_argument where the system has none of this name.
SystemParameter system_parameter(const SystemParameters& system, const std::string& name);

}  // namespace arcslip
