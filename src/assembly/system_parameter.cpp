#include "arcslip/assembly/system_parameter.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
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
  at.here.preload_growth = system.preload_growth;
  at.rate = {Variation::none(), Variation::none(), 0, 0, 0, 0, 0};
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

/// By a factor on the stiffness, at the same limit.
void change_contact_stiffness(At& at, double value, double own) {
  at.here.contact_stiffness = value / own;
  at.rate.contact_stiffness = 1 / own;
  at.here.slip_per_preload = own / value;
  at.rate.slip_per_preload = -own / (value * value);
}

void change_contact_limit(At& at, double value, double own) {
  at.here.slip_per_preload = value / own;
  at.rate.slip_per_preload = 1 / own;
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
  at.here.base_viscous = gamma / value;
  at.rate.base_viscous = -gamma / (value * value);
  at.here.base.loss.viscous *= gamma / value;  // 2 zeta_B/gamma
  at.rate.base.loss.viscous = -at.here.base.loss.viscous / value;
}

void change_growth(At& at, double value, const SystemParameters& /*system*/) {
  at.here.preload_growth = value;
  at.rate.preload_growth = 1;
}

/// Of an element, which is made anew at each value.
void leave(At& /*at*/, double /*value*/, const SystemParameters& /*system*/) {}

using Kind = SystemParameter::Kind;

/// One that is a number of the system.
SystemParameter plain(const char* name, double SystemParameters::*member,
                      void (*change)(At& at, double value, const SystemParameters& system), Kind kind,
                      const SystemParameters& system) {
  const auto at = [start = unchanged(system), system, change](double value) {
    At varied = start;
    change(varied, value, system);
    return varied;
  };
  const auto with = [system, member](double value) {
    SystemParameters other = system;
    other.*member = value;
    return other;
  };
  return {name, system.*member, at, kind, with};
}

/// One of contacts that has so much of the one concerned or, of all, of the first.
SystemParameter of_contacts(const std::string& name, double own, bool is_limit, Index contact,
                            const SystemParameters& system) {
  const auto at = [=, start = unchanged(system)](double value) {
    At varied = start;
    (is_limit ? change_contact_limit : change_contact_stiffness)(varied, value, own);
    return varied;
  };
  const auto with = [=](double value) {
    SystemParameters other = system;
    const double factor = value / own;
    if (!is_limit && contact <= 0) other.interface_stiffness = value;
    for (Index i = 0; i < std::ssize(other.contacts); ++i) {
      SectorContact& one = other.contacts[static_cast<std::size_t>(i)];
      if (contact >= 0 && i != contact) continue;
      if (!is_limit) one.stiffness *= factor;
      one.slip_per_preload *= is_limit ? factor : 1 / factor;
    }
    return other;
  };
  const std::string own_name = contact < 0 ? name : fmt::format("{}_{}", name, contact + 1);
  return {own_name, own, at, Kind::contact, with, contact};
}

/// A setting of an element, which is made anew at each value.
SystemParameter of_element(std::size_t i, std::size_t setting, const SystemParameters& system) {
  const PlacedElement& placed = system.others[i];
  const auto with = [=](double value) {
    SystemParameters other = system;
    other.others[i].settings[setting] = value;
    return other;
  };
  const auto at = [start = unchanged(system)](double /*value*/) { return start; };
  return {setting_name(system, i, setting), placed.settings[setting], at, Kind::element, with, -1,
          placed.kind->settings[setting]};
}

}  // namespace

double SystemParameter::scale(double other, double preload, double eta) const {
  constexpr double small = 1e-4;  // of the system's own value: what crosses zero has no size of its own there
  const bool may_vanish = kind == Kind::damping || (kind == Kind::element && limits.low < 0);
  const double least = kind == Kind::growth ? preload / (eta * eta)
                       : may_vanish         ? small * std::abs(value)
                                            : 0;
  const double size = std::max(std::abs(other), least);
  return size > 0 ? size : 1;
}

std::vector<std::string> system_parameter_names() {
  return {"F", "zeta_B", "zeta_D", "K_FD", "P_2", "L", "M*", "gamma", "cubic_stiffness"};
}

std::vector<SystemParameter> system_parameters(const SystemParameters& system) {
  using S = SystemParameters;
  std::vector<SystemParameter> all{
      plain("F", &S::force, change_load, Kind::load, system),
      plain("zeta_B", &S::base_damping, change_base_damping, Kind::damping, system),
      plain("zeta_D", &S::damper_damping, change_damper_damping, Kind::damping, system),
      of_contacts("K_FD", system.interface_stiffness, false, -1, system),
      plain("P_2", &S::preload_growth, change_growth, Kind::growth, system)};
  for (std::size_t i = 0; i < system.others.size(); ++i) {
    for (std::size_t k = 0; k < system.others[i].settings.size(); ++k)
      all.push_back(of_element(i, k, system));
  }
  if (!system.sectors) {
    all.push_back(plain("M*", &S::mass_ratio, change_mass_ratio, Kind::ratio, system));
    all.push_back(plain("gamma", &S::frequency_ratio, change_frequency_ratio, Kind::ratio, system));
    all.push_back(plain("cubic_stiffness", &S::cubic_stiffness, leave, Kind::element, system));
    all.back().limits = any_value("", 0, "");
    return all;
  }
  const Index count = std::ssize(system.contacts);
  for (Index i = -1; i < (count > 1 ? count : 0); ++i) {
    const SectorContact& one = system.contacts[static_cast<std::size_t>(std::max<Index>(i, 0))];
    all.push_back(of_contacts("L", one.stiffness * one.slip_per_preload, true, i, system));
    if (i < 0) continue;
    const double own = one.stiffness * static_cast<double>(system.elements);
    all.push_back(of_contacts("K_FD", own, false, i, system));
  }
  return all;
}

std::vector<std::string> system_parameter_names(const SystemParameters& system) {
  std::vector<std::string> names;
  for (const SystemParameter& one : system_parameters(system)) names.push_back(one.name);
  return names;
}

SystemParameters with_parameter(const SystemParameters& system, const std::string& name, double value) {
  return system_parameter(system, name).system(value);
}

SystemParameter system_parameter(const SystemParameters& system, const std::string& name) {
  for (SystemParameter& one : system_parameters(system)) {
    if (one.name == name) return std::move(one);
  }
  throw std::invalid_argument(fmt::format("the system has no parameter {}; it has {}", name,
                                          fmt::join(system_parameter_names(system), ", ")));
}

}  // namespace arcslip
