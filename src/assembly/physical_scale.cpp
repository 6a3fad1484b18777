#include "arcslip/assembly/physical_scale.hpp"

#include <cmath>

namespace arcslip {

double RectangularRing::mass(double circumference) const { return density * width * height * circumference; }

double RectangularRing::stiffness(StructureModel model, double circumference) const {
  const double axial = elastic_modulus * width * height / circumference;
  const double ratio = height / circumference;
  return model == StructureModel::rods ? axial : axial * ratio * ratio / 12;
}

void set_groups(const Geometry& geometry, SystemParameters& system) {
  const double L = geometry.circumference;
  const double base_stiffness = geometry.base.stiffness(system.model, L);
  const double stiffness_ratio = base_stiffness / geometry.damper.stiffness(system.model, L);
  system.mass_ratio = geometry.base.mass(L) / geometry.damper.mass(L);
  system.frequency_ratio = std::sqrt(stiffness_ratio / system.mass_ratio);
  system.interface_stiffness =
      shear_interface_stiffness(system.model, L / geometry.damper.height, geometry.damper.poisson_ratio);
  system.force = geometry.force_per_length / base_stiffness;
  system.preload = geometry.friction_coefficient * geometry.preload_per_length / base_stiffness;
}

PhysicalScale::PhysicalScale(const Geometry& geometry, const SystemParameters& system)
    : circumference_(geometry.circumference),
      base_stiffness_(geometry.base.stiffness(system.model, circumference_)),
      interface_stiffness_(system.interface_stiffness) {
  const double damper_stiffness = geometry.damper.stiffness(system.model, circumference_);
  const double natural = std::sqrt(damper_stiffness / geometry.damper.mass(circumference_));
  frequency_ = system.model == StructureModel::rods ? natural : two_pi * natural;
  preload_ = base_stiffness_ / geometry.friction_coefficient;
  energy_ = damper_stiffness * circumference_ * circumference_;
}

}  // namespace arcslip
