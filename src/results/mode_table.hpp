#pragma once

// Natural frequencies of base, damper and the stuck whole, for every number of waves round the circumference.

#include <map>
#include <string>
#include <vector>

#include "arcslip/assembly/resonances.hpp"
#include "arcslip/cases/case_file.hpp"

namespace arcslip {

/// Those of one number of waves.
struct WaveModes {
  Index wave_number;
  std::vector<Resonance> modes;  ///< part by part, ascending
  std::string refusal;           ///< why there are none, of a wave under which nothing holds what turns
};

/// Calls `visit` with the number of each mode within its part, from 1.
template <class Visit>
void for_each_mode(const std::vector<Resonance>& modes, const Visit& visit) {
  std::map<std::string, Index> numbers;
  for (const Resonance& mode : modes) visit(mode, ++numbers[mode.part]);
}

/// "eta", of systems in SI units "eta,frequency_Hz", and these numbers.
std::string frequency_names(const ProblemRequest& problem);
std::string frequency_columns(const ProblemRequest& problem, double eta);

/// Of the waves that the structure has, up to `highest`, of what turns in both directions, of sectors below
/// the end of their window, above which not all are known. Throws std::exception where one cannot be had, but
/// of waves of sectors that turn beside the system's own.
std::vector<WaveModes> modes_of(const ProblemRequest& problem, Index highest);

/// modes.csv: wave_number, part, mode (from 1 in each part), eta, frequency_Hz of systems in SI units, zeta.
std::string modes_csv(const ProblemRequest& problem, const std::vector<WaveModes>& waves);

/// The same for people: a row for each wave, a column for each mode; frequencies in Hz where they are known.
std::string modes_text(const ProblemRequest& problem, const std::vector<WaveModes>& waves);

}  // namespace arcslip
