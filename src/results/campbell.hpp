#pragma once

// Campbell diagrams: the natural frequencies of sectors that turn over their speed, and where engine orders
// meet them.

#include <string>

#include "arcslip/cases/case_file.hpp"

namespace arcslip {

/// The speeds, in revolutions, 0 <= low < high.
struct CampbellRange {
  double low = 0;
  double high = 0;
};

/// Refuses what has none. Throws std::invalid_argument.
void check_campbell(const SystemParameters& system);

/// campbell.csv: speed, wave_number, part, mode (from 1 in each part), eta, frequency_Hz of systems in SI
/// units, zeta; of the system's wave and the one that runs the other way, at speeds evenly from low to high.
/// Throws SectorError.
std::string campbell_csv(const ProblemRequest& problem, const CampbellRange& range);

/// crossings.csv: engine_order, wave_number, part, mode, speed, eta, frequency_Hz; where the orders m that
/// act as these waves, up to twice the sectors, meet a mode: exactly, as modes of K v = eta^2 (M - K_2/m^2 -
/// j G/m) v.
std::string crossings_csv(const ProblemRequest& problem, const CampbellRange& range);

}  // namespace arcslip
