#pragma once

// [system] with model = "sector": base and damper from the matrices of one sector each.

#include "arcslip/assembly/sector_pair.hpp"
#include "cases/system_section.hpp"

namespace arcslip {

/// [system.base] or [system.damper] as it is read.
struct PartSettings : SectorPart {
  SectorPath path = SectorPath::reduced;
  std::string folder = {};  ///< that the names of files start from
  double mass_factor = 0;   ///< alpha of alpha M
};

const KeyTable<FrictionSettings>& sector_keys();
/// With a load, which the base has.
const KeyTable<PartSettings>& part_keys(bool loaded);

/// Whether [system] has this model.
bool is_sector(const TomlDocument& document);

/// What [system.base] and [system.damper] say, with their files read; null of other models. Throws
/// InputError.
std::shared_ptr<const SectorPair> read_sectors(const TomlDocument& document);

/// Reads [system]. Throws InputError.
void read_sector_system(const TomlSection& section, FrictionSettings& settings);

}  // namespace arcslip
