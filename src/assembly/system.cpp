#include "arcslip/assembly/system.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "arcslip/assembly/reduced_pair.hpp"
#include "arcslip/assembly/sector_pair.hpp"

namespace arcslip {

std::string to_string(StructureModel model) {
  if (model == StructureModel::sector) return "sector";
  return model == StructureModel::rods ? "rods" : "beams";
}

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

ReducedPair reduce(const SystemParameters& parameters) {
  const Index n = parameters.wave_number;
  const Index elements = parameters.elements;
  const auto make = parameters.model == StructureModel::rods ? rod_element : beam_element;
  ReducedPair pair{
      reduce(make(parameters.mass_ratio, parameters.stiffness_ratio(), n, elements), n, elements),
      reduce(make(1, 1, n, elements), n, elements)};
  pair.base.load *= PreciseComplex(parameters.force * parameters.stiffness_ratio());
  pair.damper.load.setZero();
  return pair;
}

Loss base_loss_per_zeta(const SystemParameters& parameters) {
  if (parameters.sectors) return parameters.sectors->base().loss_per_zeta();
  if (parameters.base_damping_kind == DampingKind::structural) return {0, 2};
  return {2 / parameters.frequency_ratio, 0};
}

Loss base_loss_fixed(const SystemParameters& parameters) {
  return parameters.sectors ? parameters.sectors->base().fixed : Loss{};
}

Loss damper_loss_per_zeta(const SystemParameters& parameters) {
  if (!parameters.sectors) return {2, 0};
  const SectorPart* damper = parameters.sectors->damper();
  return damper != nullptr ? damper->loss_per_zeta() : Loss{};
}

Loss damper_loss_fixed(const SystemParameters& parameters) {
  const SectorPart* damper = parameters.sectors ? parameters.sectors->damper() : nullptr;
  return damper != nullptr ? damper->fixed : Loss{};
}

double cubic_coefficient(const SystemParameters& parameters) {
  return parameters.cubic_stiffness * parameters.stiffness_ratio() / static_cast<double>(parameters.elements);
}

FrictionSystem build_system(const SystemParameters& parameters) {
  if (parameters.sectors) return build_sector_system(parameters);
  const ReducedPair pair = reduce(parameters);
  const Loss base_loss = parameters.base_damping_kind == DampingKind::structural
                             ? Loss{0, 2 * parameters.base_damping}
                             : Loss{base_damping_factor(parameters), 0};
  const ModalModel damper =
      parameters.fixed_damper ? ModalModel() : ModalModel(pair.damper, 0, damper_damping_factor(parameters));
  const auto elements = static_cast<double>(parameters.elements);
  return {ModalModel(pair.base, 0, base_loss),
          damper,
          parameters.interface_stiffness / elements,
          parameters.stiffness_ratio() / parameters.interface_stiffness,
          base_loss_per_zeta(parameters),
          cubic_coefficient(parameters),
          parameters.preload_growth,
          {},
          {}};
}

}  // namespace arcslip
