#pragma once

// [system.base] and [system.damper] of sectors: the matrices of one sector each.

#include "arcslip/assembly/sector_pair.hpp"
#include "keys/key_table.hpp"

namespace arcslip {

/// One of them as it is read.
struct PartSettings : SectorPart {
  SectorPath path = SectorPath::reduced;
  double mass_factor = 0;  ///< alpha of alpha M
};

/// With a load, which the base has.
const KeyTable<PartSettings>& part_keys(bool loaded);

/// Reads the table at this path, with its files, for a response found this way. Throws InputError.
SectorPart read_part(const TomlDocument& document, const std::string& path, SectorPath response);

}  // namespace arcslip
