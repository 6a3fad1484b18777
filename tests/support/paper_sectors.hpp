#pragma once

// The paper's rods and beams as finite-element sectors with case files.

#include <fmt/format.h>

#include "arcslip/cases/runs.hpp"
#include "arcslip/results/results.hpp"
#include "case_runs.hpp"
#include "paper_cases.hpp"
#include "program.hpp"
#include "sector_files.hpp"

namespace arcslip::testing {

struct PaperSectors {
  FiniteSector base;
  FiniteSector damper;
};

/// The paper's base (M* = 5, gamma = 4, F = 1) and damper, one sector each of `count` elements of 30.
inline PaperSectors paper_sectors(bool beams, Index count) {
  const auto element = beams ? beam_element : rod_element;
  PaperSectors sectors{chain(element(5, 80, 1, 30), count, forward(1, 30)),
                       chain(element(1, 1, 1, 30), count, forward(1, 30))};
  sectors.base.load *= 80;
  sectors.damper.load.setZero();
  for (FiniteSector* sector : {&sectors.base, &sectors.damper}) sector->contacts = {0};
  return sectors;
}

inline double interface_stiffness(bool beams) { return beams ? shear_interface_stiffness(33.3, 0.3) : 1000; }

inline std::string paper_system(const TemporaryFolder& folder, bool beams, Index count) {
  const PaperSectors sectors = paper_sectors(beams, count);
  return fmt::format(
             "[system]\nmodel = \"sector\"\nwave_number = 1\nsectors = {}\ncontact_stiffness = {:.17g}\n"
             "limit_per_preload = {:.17g}\npreload = 1.0\n",
             30 / count, interface_stiffness(beams) / 30, 80.0 / 30) +
         write_sector(folder, "base", sectors.base, "damping_kind = \"viscous\"\nreference_frequency = 4.0") +
         write_sector(folder, "damper", sectors.damper,
                      "damping_kind = \"viscous\"\nreference_frequency = 1.0");
}

/// Columns of branches.csv by name, with numbers for numbers.
inline std::vector<std::vector<std::string>> branches_csv(const Case& input) {
  std::vector<TracedBranch> traced;
  for (const CaseBranch& request : input.branches) {
    for (TracedBranch& one : trace(request)) traced.push_back(std::move(one));
  }
  const TemporaryFolder folder;
  std::string text;
  write_branches(traced, [&](std::string_view piece) { text += piece; });
  return read_csv(folder.write("branches.csv", text));
}

inline const std::string over_all_eta = "[branch]\nparameter = \"eta\"\nfrom = 0.5\nto = 120.0\n";

}  // namespace arcslip::testing
