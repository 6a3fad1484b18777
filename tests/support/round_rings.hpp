#pragma once

// Two rings in SI units whose groups can be worked out by hand.

#include "arcslip/assembly/physical_scale.hpp"

namespace arcslip::testing {

constexpr double rounding = 1e-13;  // a dozen operations on doubles

/// Round numbers, so that the groups can be worked out by hand.
inline Geometry round_numbers() {
  Geometry geometry;
  geometry.base = {1e11, 8000, 0.3, 0.1, 0.04};
  geometry.damper = {2e11, 4000, 0.25, 0.05, 0.01};
  geometry.circumference = 2;
  geometry.friction_coefficient = 0.25;
  geometry.preload_per_length = 3000;
  geometry.force_per_length = 50;
  return geometry;
}

inline SystemParameters groups_of(const Geometry& geometry, StructureModel model, Index wave_number = 1) {
  SystemParameters system;
  system.model = model;
  system.wave_number = wave_number;
  set_groups(geometry, system);
  return system;
}

}  // namespace arcslip::testing
