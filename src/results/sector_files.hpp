#pragma once

// A pair of sectors as files that `arcslip run` and `study` read: matrices, lists of dofs and the case file.

#include <string>

#include "arcslip/sectors/finite_sector.hpp"

namespace arcslip {

/// Damping of a structure: loss 2 zeta eta/reference where `reference` is > 0, else 2 zeta.
struct SectorDamping {
  double zeta = 1e-4;
  double reference = 0;
};

struct SectorCase {
  std::string title;
  std::string notes;  ///< comment lines at the head of the case file, each begun with #
  bool si = false;    ///< in kg, N and m, which the case file then says
  Index wave_number = 1;
  Index sectors = 1;
  FiniteSector base;    ///< with the load of unit force
  FiniteSector damper;  ///< without load; as many contacts as the base
  SectorDamping base_damping;
  SectorDamping damper_damping;
  double contact_stiffness = 1;
  double limit_per_preload = 1;
  double force = 1;
  double preload = 1;
  double speed =
      0;  ///< of rotation, in revolutions in the unit of time, whose matrices the sectors have then
  double eta_from = 0;  ///< of the branches and of the study's window
  double eta_to = 0;
};

/// Writes base_mass.mtx, base_stiffness.mtx, of what turns base_stiffness_speed2.mtx
/// and, where Coriolis' forces act, base_gyroscopic.mtx, base_left.txt, base_right.txt and base_load.txt, the
/// same of the damper but for the load, and case.toml, all of them or none. Throws OutputError.
void write_sector_case(const std::string& folder, const SectorCase& input);

}  // namespace arcslip
