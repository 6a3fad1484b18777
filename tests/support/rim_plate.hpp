#pragma once

#include "arcslip/sectors/annular_plate.hpp"

namespace arcslip::testing {

/// A sector of an annular plate of cast iron, loaded and touched at one dof of its rim.
inline FiniteSector rim_plate(Index sectors, Index radial_elements, Index angular_elements) {
  FiniteSector sector = annular_plate_sector({.inner_radius = 0.06,
                                              .outer_radius = 0.15,
                                              .thickness = 0.012,
                                              .youngs_modulus = 1.1e11,
                                              .poisson_ratio = 0.26,
                                              .density = 7200,
                                              .sectors = sectors,
                                              .radial_elements = radial_elements,
                                              .angular_elements = angular_elements});
  sector.contacts.resize(1);
  sector.outputs.clear();
  sector.load(sector.contacts.front()) = 1;
  return sector;
}

}  // namespace arcslip::testing
