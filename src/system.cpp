#include "arcslip/system.hpp"

#include <cmath>

namespace arcslip {

std::string to_string(StructureModel model) { return model == StructureModel::rods ? "rods" : "beams"; }

double shear_interface_stiffness(double slenderness, double poisson_ratio) {
  return 12 * std::pow(slenderness, 4) / (1 + poisson_ratio);
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

FrictionSystem build_system(const SystemParameters& parameters) {
  const ReducedPair pair = reduce(parameters);
  return {ModalModel(pair.base, 0, base_damping_factor(parameters)),
          ModalModel(pair.damper, 0, damper_damping_factor(parameters)),
          parameters.interface_stiffness / static_cast<double>(parameters.elements),
          parameters.stiffness_ratio() / parameters.interface_stiffness};
}

}  // namespace arcslip
