#include "arcslip/assembly/system_parameter.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "arcslip/assembly/structures.hpp"
#include "assembly/system_numbers.hpp"

namespace arcslip {
namespace {

using At = SystemParameter::At;

/// Nothing changes.
At unchanged(const SystemParameters& system) {
  At at;
  const PairLosses losses = structures_of(system).losses(system);
  at.here.base.loss = losses.base(system);
  at.here.damper.loss = losses.damper(system);
  at.here.preload_growth = system.preload_growth;
  at.rate = {Variation::none(), Variation::none(), 0, 0, 0, 0, 0};
  return at;
}

void change_load(At& at, double value, const SystemParameters& system) {
  at.here.base.load = value / system.force;
  at.rate.base.load = 1 / system.force;
}

void change_base_damping(At& at, double value, const SystemParameters& system) {
  const PairLosses losses = structures_of(system).losses(system);
  at.rate.base.loss = losses.base_per_zeta;
  at.here.base.loss = losses.base_fixed + value * at.rate.base.loss;
}

void change_damper_damping(At& at, double value, const SystemParameters& system) {
  const PairLosses losses = structures_of(system).losses(system);
  at.rate.damper.loss = losses.damper_per_zeta;
  at.here.damper.loss = losses.damper_fixed + value * at.rate.damper.loss;
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

void change_growth(At& at, double value, const SystemParameters& /*system*/) {
  at.here.preload_growth = value;
  at.rate.preload_growth = 1;
}

void change_influence(At& at, double value, const SystemParameters& system) {
  at.here.base.influence = value / system.influence_factor;
  at.rate.base.influence = 1 / system.influence_factor;
}

using Kind = SystemParameter::Kind;

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

SystemParameter system_number(const char* name, double SystemParameters::*member, Change change,
                              SystemParameter::Kind kind, const SystemParameters& system) {
  return system_number(
      name, system.*member, [=](At& at, double value) { change(at, value, system); }, kind,
      [member](SystemParameters& other, double value) { other.*member = value; }, system);
}

SystemParameter system_number(const std::string& name, double own,
                              const std::function<void(At&, double value)>& change, Kind kind,
                              const std::function<void(SystemParameters&, double value)>& set,
                              const SystemParameters& system) {
  const auto at = [start = unchanged(system), change](double value) {
    At varied = start;
    change(varied, value);
    return varied;
  };
  const auto with = [system, set](double value) {
    SystemParameters other = system;
    set(other, value);
    return other;
  };
  return {name, own, at, kind, with};
}

double SystemParameter::scale(double other, double preload, double eta) const {
  constexpr double small = 1e-4;  // of the system's own value: what crosses zero has no size of its own there
  const bool may_vanish =
      kind == Kind::damping || kind == Kind::flow || (kind == Kind::element && limits.low < 0);
  const double least = kind == Kind::growth  ? preload / (eta * eta)
                       : kind == Kind::speed ? eta
                       : may_vanish          ? small * std::abs(value)
                                             : 0;
  const double size = std::max(std::abs(other), least);
  return size > 0 ? size : 1;
}

std::vector<std::string> system_parameter_names() {
  return {"F",  "zeta_B", "zeta_D",          "K_FD",      "P_2",  "L",
          "M*", "gamma",  "cubic_stiffness", "influence", "speed"};
}

std::vector<SystemParameter> system_parameters(const SystemParameters& system) {
  using S = SystemParameters;
  std::vector<SystemParameter> all{
      system_number("F", &S::force, change_load, Kind::load, system),
      of_contacts("K_FD", system.interface_stiffness, false, -1, system),
      system_number("P_2", &S::preload_growth, change_growth, Kind::growth, system)};
  const bool is_whole = structures_of(system).whole() != nullptr;  // which is solved for at its own damping
  if (structures_of(system).has_equations() && !is_whole) {
    all.insert(all.begin() + 1,
               {system_number("zeta_B", &S::base_damping, change_base_damping, Kind::damping, system),
                system_number("zeta_D", &S::damper_damping, change_damper_damping, Kind::damping, system)});
  }
  if (system.influence)
    all.push_back(system_number("influence", &S::influence_factor, change_influence, Kind::flow, system));
  for (std::size_t i = 0; i < system.others.size(); ++i) {
    for (std::size_t k = 0; k < system.others[i].settings.size(); ++k)
      all.push_back(of_element(i, k, system));
  }
  for (SystemParameter& one : structures_of(system).parameters(system)) all.push_back(std::move(one));
  const Index count = std::ssize(system.contacts);  // if they are listed
  const Index named = count > 1 && !is_whole ? count : 0;
  const auto rubs = std::find_if(system.contacts.begin(), system.contacts.end(),
                                 [](const SectorContact& one) { return one.stiffness > 0; });
  const Index first = rubs == system.contacts.end() ? 0 : rubs - system.contacts.begin();
  for (Index i = count > 0 ? -1 : 0; i < named; ++i) {
    const SectorContact& one = system.contacts[static_cast<std::size_t>(i < 0 ? first : i)];
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
