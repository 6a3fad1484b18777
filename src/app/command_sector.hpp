#pragma once

// `arcslip sector`: its arguments, and what it does with them.

#include <CLI/CLI.hpp>

#include "app/sector_kinds.hpp"

namespace arcslip {

/// The brake rotor and the paper's figure 8, where not told otherwise.
struct SectorOptions {
  PairOptions pair;
  SystemParameters paper;
  std::optional<double> slenderness;
  double poisson_ratio = 0.3;  ///< of the paper's damper
  Index per_sector = 1;
  AnnularPlate plate;
  SolidRing ring;
  SolidOptions solid;
  std::string folder;
  CLI::App* rods = nullptr;
  CLI::App* beams = nullptr;
  CLI::App* plates = nullptr;
};

/// Adds the command; its kinds are commands of their own.
CLI::App* add_sector_command(CLI::App& app, SectorOptions& options);

/// Writes the files and prints what they hold.
int sector_command(const SectorOptions& options);

}  // namespace arcslip
