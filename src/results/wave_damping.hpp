#pragma once

// Damping over nodal diameters: what a wave loses to its structure, to a flow and to friction at a given
// amplitude, in all as a damping ratio.

#include <string>
#include <vector>

#include "arcslip/cases/case_file.hpp"

namespace arcslip {

/// One mode of base and damper at an amplitude.
struct DampedWave {
  Index wave_number;  ///< below 0 of waves that run against the numbers of the sectors
  Index mode;         ///< from 1, of those that are stuck
  double amplitude;   ///< R of the first contact
  double eta;         ///< of the nonlinear mode; NaN where it is not found
  double zeta;        ///< the same; negative where it gains
};

/// Of the waves that the structure has, up to `highest` either way round where a flow acts, else one way, and
/// of their modes that `modes_of` tells, at each amplitude > 0.
std::vector<DampedWave> damping_of_waves(const ProblemRequest& problem, Index highest,
                                         const std::vector<double>& amplitudes);

/// damping.csv: wave_number, mode, R, eta, frequency_Hz of systems in SI units, zeta.
std::string damping_csv(const ProblemRequest& problem, const std::vector<DampedWave>& waves);

/// The same of first modes for people: a row for each wave, a column for each amplitude.
std::string damping_text(const std::vector<DampedWave>& waves, const std::vector<double>& amplitudes);

}  // namespace arcslip
