#pragma once

// What `arcslip sector` makes: pairs of sectors of known shapes, with the frequencies between which to look.

#include <optional>

#include "arcslip/assembly/system.hpp"
#include "arcslip/sectors/annular_plate.hpp"
#include "arcslip/time/ring_sector.hpp"
#include "results/sector_files.hpp"

namespace arcslip {

/// A request that cannot be met; what() is one line.
class SectorKindError : public std::invalid_argument {
 public:
  using std::invalid_argument::invalid_argument;
};

/// What all kinds share.
struct PairOptions {
  Index wave_number = 3;
  double force = 1;  ///< amplitude of the travelling force, of the paper's kinds F, else on one sector
  double preload = 1;
  double base_damping = 1e-4;
  double damper_damping = 1e-4;
  std::optional<double> eta_from;  ///< by default around the base's lowest frequency, free and held
  std::optional<double> eta_to;
};

/// The paper's rods or beams, `per_sector` elements to a sector, a contact at each node. `system` gives M*,
/// gamma, K_FD and N.
SectorCase paper_case(const PairOptions& options, const SystemParameters& system, Index per_sector);

/// Elastic structures in SI units, structural damping, with a ring of as many sectors as the damper and
/// `contacts` equally spaced contacts in a sector.
struct SolidOptions {
  SolidRing damper;
  Index contacts = 1;
  std::optional<double> contact_stiffness;  ///< by default of the inner half of the damper in shear
  double speed = 0;                         ///< of both, revolutions a second; 0: at rest
};

SectorCase plate_case(const PairOptions& options, const AnnularPlate& plate, const SolidOptions& solid);
SectorCase ring_case(const PairOptions& options, const SolidRing& base, const SolidOptions& solid);

}  // namespace arcslip
