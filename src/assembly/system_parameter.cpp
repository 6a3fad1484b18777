#include "arcslip/assembly/system_parameter.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
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

void change_load(At& at, double value, const SystemParameters& system) {
  at.here.base.load = value / system.force;
  at.rate.base.load = 1 / system.force;
}

void change_base_damping(At& at, double value, const SystemParameters& system) {
  at.rate.base.loss = base_loss_per_zeta(system);
  at.here.base.loss = base_loss_fixed(system) + value * at.rate.base.loss;
}

void change_damper_damping(At& at, double value, const SystemParameters& system) {
  at.rate.damper.loss = damper_loss_per_zeta(system);
  at.here.damper.loss = damper_loss_fixed(system) + value * at.rate.damper.loss;
}

void change_contact_stiffness(At& at, double value, const SystemParameters& system) {
  const double K = system.interface_stiffness;
  at.here.contact_stiffness = value / K;
  at.rate.contact_stiffness = 1 / K;
  at.here.slip_per_preload = K / value;
  at.rate.slip_per_preload = -K / (value * value);
}

/// All that goes with the base's stiffness, as K* grows by a factor with this rate.
void follow_stiffness(At& at, double factor, double rate) {
  at.here.base.stiffness = at.here.base.load = at.here.slip_per_preload = at.here.others = factor;
  at.rate.base.stiffness = at.rate.base.load = at.rate.slip_per_preload = at.rate.others = rate;
}

void change_mass_ratio(At& at, double value, const SystemParameters& system) {
  follow_stiffness(at, value / system.mass_ratio, 1 / system.mass_ratio);
  at.here.base.mass = value / system.mass_ratio;
  at.rate.base.mass = 1 / system.mass_ratio;
}

void change_frequency_ratio(At& at, double value, const SystemParameters& system) {
  const double gamma = system.frequency_ratio;
  follow_stiffness(at, value * value / (gamma * gamma), 2 * value / (gamma * gamma));
  at.here.base.loss.viscous *= gamma / value;  // 2 zeta_B/gamma
  at.rate.base.loss.viscous = -at.here.base.loss.viscous / value;
}

using Kind = SystemParameter::Kind;

struct Entry {
  const char* name;
  double SystemParameters::*member;
  void (*change)(At& at, double value, const SystemParameters& system);
  Kind kind;
};

constexpr Entry all[] = {
    {"F", &SystemParameters::force, change_load, Kind::load},
    {"zeta_B", &SystemParameters::base_damping, change_base_damping, Kind::damping},
    {"zeta_D", &SystemParameters::damper_damping, change_damper_damping, Kind::damping},
    {"K_FD", &SystemParameters::interface_stiffness, change_contact_stiffness, Kind::contact},
    {"M*", &SystemParameters::mass_ratio, change_mass_ratio, Kind::ratio},
    {"gamma", &SystemParameters::frequency_ratio, change_frequency_ratio, Kind::ratio}};

const Entry& entry_of(const SystemParameters& system, const std::string& name) {
  const auto found =
      std::find_if(std::begin(all), std::end(all), [&](const Entry& entry) { return entry.name == name; });
  if (found == std::end(all)) throw std::invalid_argument(fmt::format("there is no parameter {}", name));
  if (system.sectors && found->kind == Kind::ratio)
    throw std::invalid_argument(fmt::format("{} is only of rods and beams", name));
  return *found;
}

}  // namespace

std::vector<std::string> system_parameter_names() {
  std::vector<std::string> names;
  for (const Entry& entry : all) names.emplace_back(entry.name);
  return names;
}

SystemParameters with_parameter(SystemParameters system, const std::string& name, double value) {
  const double factor = value / system.interface_stiffness;
  const Entry& entry = entry_of(system, name);
  system.*entry.member = value;
  if (entry.kind != Kind::contact) return system;
  for (SectorContact& contact : system.contacts) {
    contact.stiffness *= factor;
    contact.slip_per_preload /= factor;
  }
  return system;
}

SystemParameter system_parameter(const SystemParameters& system, const std::string& name) {
  const Entry& entry = entry_of(system, name);
  const auto at = [start = unchanged(system), system, change = entry.change](double value) {
    At varied = start;
    change(varied, value, system);
    return varied;
  };
  return {name, system.*entry.member, at, entry.kind};
}

}  // namespace arcslip
