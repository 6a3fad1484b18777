#include "arcslip/assembly/system_parameter.hpp"

#include <fmt/format.h>

#include <stdexcept>

#include "arcslip/assembly/sector_pair.hpp"
#include "arcslip/assembly/system.hpp"

namespace arcslip {
namespace {

using At = SystemParameter::At;

/// Nothing changes.
At unchanged(const SystemParameters& system) {
  At at;
  at.here.base.loss = base_loss_fixed(system) + system.base_damping * base_loss_per_zeta(system);
  at.here.damper.loss = damper_loss_fixed(system) + system.damper_damping * damper_loss_per_zeta(system);
  at.rate = {Variation::none(), Variation::none(), 0, 0, 0};
  return at;
}

SystemParameter load(const SystemParameters& system) {
  return {"F", system.force,
          [start = unchanged(system), F = system.force](double value) {
            At at = start;
            at.here.base.load = value / F;
            at.rate.base.load = 1 / F;
            return at;
          },
          true};
}

SystemParameter base_damping(const SystemParameters& system) {
  return {"zeta_B", system.base_damping,
          [start = unchanged(system), fixed = base_loss_fixed(system),
           per_zeta = base_loss_per_zeta(system)](double value) {
            At at = start;
            at.here.base.loss = fixed + value * per_zeta;
            at.rate.base.loss = per_zeta;
            return at;
          },
          false, -1};
}

SystemParameter damper_damping(const SystemParameters& system) {
  return {"zeta_D", system.damper_damping,
          [start = unchanged(system), fixed = damper_loss_fixed(system),
           per_zeta = damper_loss_per_zeta(system)](double value) {
            At at = start;
            at.here.damper.loss = fixed + value * per_zeta;
            at.rate.damper.loss = per_zeta;
            return at;
          },
          false, -1};
}

SystemParameter contact_stiffness(const SystemParameters& system) {
  return {"K_FD", system.interface_stiffness,
          [start = unchanged(system), K = system.interface_stiffness](double value) {
            At at = start;
            at.here.contact_stiffness = value / K;
            at.rate.contact_stiffness = 1 / K;
            at.here.slip_per_preload = K / value;
            at.rate.slip_per_preload = -K / (value * value);
            return at;
          }};
}

/// All that goes with the base's stiffness, as K* grows by a factor with this rate.
void follow_stiffness(At& at, double factor, double rate) {
  at.here.base.stiffness = at.here.base.load = at.here.slip_per_preload = at.here.others = factor;
  at.rate.base.stiffness = at.rate.base.load = at.rate.slip_per_preload = at.rate.others = rate;
}

SystemParameter mass_ratio(const SystemParameters& system) {
  return {"M*", system.mass_ratio, [start = unchanged(system), M = system.mass_ratio](double value) {
            At at = start;
            follow_stiffness(at, value / M, 1 / M);
            at.here.base.mass = value / M;
            at.rate.base.mass = 1 / M;
            return at;
          }};
}

SystemParameter frequency_ratio(const SystemParameters& system) {
  return {"gamma", system.frequency_ratio,
          [start = unchanged(system), gamma = system.frequency_ratio](double value) {
            At at = start;
            follow_stiffness(at, value * value / (gamma * gamma), 2 * value / (gamma * gamma));
            at.here.base.loss.viscous *= gamma / value;  // 2 zeta_B/gamma
            at.rate.base.loss.viscous = -at.here.base.loss.viscous / value;
            return at;
          }};
}

struct Entry {
  const char* name;
  SystemParameter (*make)(const SystemParameters&);
  double SystemParameters::*member;
  bool of_sectors;
};

constexpr Entry all[] = {{"F", load, &SystemParameters::force, true},
                         {"zeta_B", base_damping, &SystemParameters::base_damping, true},
                         {"zeta_D", damper_damping, &SystemParameters::damper_damping, true},
                         {"K_FD", contact_stiffness, &SystemParameters::interface_stiffness, true},
                         {"M*", mass_ratio, &SystemParameters::mass_ratio, false},
                         {"gamma", frequency_ratio, &SystemParameters::frequency_ratio, false}};

const Entry& entry_of(const SystemParameters& system, const std::string& name) {
  for (const Entry& entry : all) {
    if (entry.name == name && (entry.of_sectors || !system.sectors)) return entry;
  }
  throw std::invalid_argument(fmt::format("the system has no parameter {}", name));
}

}  // namespace

std::vector<std::string> system_parameter_names(bool of_sectors) {
  std::vector<std::string> names;
  for (const Entry& entry : all) {
    if (entry.of_sectors || !of_sectors) names.emplace_back(entry.name);
  }
  return names;
}

SystemParameters with_parameter(SystemParameters system, const std::string& name, double value) {
  const double factor = value / system.interface_stiffness;
  const Entry& entry = entry_of(system, name);
  system.*entry.member = value;
  if (entry.member != &SystemParameters::interface_stiffness) return system;
  for (SectorContact& contact : system.contacts) {
    contact.stiffness *= factor;
    contact.slip_per_preload /= factor;
  }
  return system;
}

SystemParameter system_parameter(const SystemParameters& system, const std::string& name) {
  return entry_of(system, name).make(system);
}

}  // namespace arcslip
