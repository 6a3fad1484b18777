#include "arcslip/assembly/system.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "arcslip/assembly/harmonic_system.hpp"
#include "arcslip/assembly/structures.hpp"
#include "arcslip/motion/swing.hpp"

namespace arcslip {

std::string to_string(StructureModel model) { return model == StructureModel::rods ? "rods" : "beams"; }

std::string to_string(DampingKind kind) {
  if (kind == DampingKind::modal) return "modal";
  return kind == DampingKind::viscous ? "viscous" : "structural";
}

std::string element_name(const SystemParameters& parameters, std::size_t i) {
  const PlacedElement& placed = parameters.others[i];
  if (!placed.name.empty()) return placed.name;
  const auto first = parameters.others.begin();
  const auto before = std::count_if(first, first + static_cast<std::ptrdiff_t>(i),
                                    [&](const PlacedElement& one) { return one.kind == placed.kind; });
  return before == 0 ? placed.kind->name : fmt::format("{}_{}", placed.kind->name, before + 1);
}

std::string setting_name(const SystemParameters& parameters, std::size_t i, std::size_t setting) {
  return element_name(parameters, i) + "." + parameters.others[i].kind->settings[setting].name;
}

std::vector<int> odd_up_to(int highest) {
  std::vector<int> orders;
  for (int h = 1; h <= highest; h += 2) orders.push_back(h);
  return orders;
}

std::vector<int> all_up_to(int highest) {
  std::vector<int> orders{1, 0};
  for (int h = 2; h <= highest; ++h) orders.push_back(h);
  return orders;
}

std::vector<int> orders_up_to(int highest, int periods, bool odd) {
  std::vector<int> orders =
      odd ? odd_up_to(std::max(highest, periods)) : all_up_to(std::max(highest, periods));
  if (periods == 1) return orders;
  std::sort(orders.begin(), orders.end());
  const auto first = std::find(orders.begin(), orders.end(), periods);
  std::rotate(orders.begin(), first, first + 1);
  return orders;
}

std::vector<int> orders_up_to(int highest, const SystemParameters& system) {
  const int most = most_orders(system);
  const bool odd = is_odd(system) && all_odd(system.harmonics);
  return orders_up_to(std::min(highest, odd ? 2 * most - 1 : most - 1), system.periods(), odd);
}

std::vector<Index> subharmonic_waves(Index wave_number, Index elements, int periods) {
  std::vector<Index> waves;
  for (Index turn = 0; turn < periods; ++turn) {
    const Index all = wave_number + turn * elements;
    if (all % periods == 0) waves.push_back(all / periods);
  }
  return waves;
}

int most_orders(const SystemParameters& system) {
  Index widest = is_odd(system) ? 1 : 2;
  for (const PlacedElement& one : system.others) widest = std::max(widest, one.coordinates());
  return most_harmonics / static_cast<int>(widest);
}

bool is_odd(const SystemParameters& system) {
  return system.excitation.is_odd() && std::all_of(system.others.begin(), system.others.end(),
                                                   [](const PlacedElement& one) { return one.is_odd(); });
}

bool has_own_friction(const SystemParameters& system) {
  return std::any_of(system.others.begin(), system.others.end(), [](const PlacedElement& one) {
    const auto& settings = one.kind->settings;
    return std::any_of(settings.begin(), settings.end(),
                       [](const ElementKind::Value& setting) { return setting.power_of_friction != 0; });
  });
}

double shear_interface_stiffness(double slenderness, double poisson_ratio) {
  return 12 * std::pow(slenderness, 4) / (1 + poisson_ratio);
}

double shear_interface_stiffness(StructureModel model, double slenderness, double poisson_ratio) {
  if (model == StructureModel::beams) return shear_interface_stiffness(slenderness, poisson_ratio);
  return slenderness * slenderness / (1 + poisson_ratio);
}

double base_damping_factor(const SystemParameters& parameters) {
  return 2 * parameters.base_damping / parameters.frequency_ratio;
}

double damper_damping_factor(const SystemParameters& parameters) { return 2 * parameters.damper_damping; }

double cubic_coefficient(const SystemParameters& parameters) {
  return parameters.cubic_stiffness * parameters.stiffness_ratio() / static_cast<double>(parameters.elements);
}

FrictionSystem build_system(const SystemParameters& parameters) {
  const int p = parameters.periods();
  const SystemParameters wave = in_order(parameters, p);
  FrictionSystem system = structures_of(parameters).one_contact(wave);
  add_influence(wave, system);
  const Complex turn = parameters.excitation.turn(1);
  if (turn == 1.0) return system;
  system.base = system.base.turned(turn);
  for (ContactOutput& output : system.outputs) output.modes = output.modes.turned(turn);
  return system;
}

}  // namespace arcslip
