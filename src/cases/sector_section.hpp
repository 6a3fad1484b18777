#pragma once

// [system] with model = "sector": base and damper from the matrices of one sector each.

#include <memory>

#include "arcslip/assembly/sector_pair.hpp"
#include "cases/system_section.hpp"

namespace arcslip {

/// Whether [system] has this model.
bool is_sector(const TomlDocument& document);

std::vector<std::string> sector_keys();

/// What [system.base] and [system.damper] say, with their files read; null of other models. Throws
/// InputError.
std::shared_ptr<const SectorPair> read_sectors(const TomlDocument& document);

/// Reads [system] but for its damping. Throws InputError.
void read_sector_system(const TomlDocument& document, const TomlSection& section, const SystemUse& use,
                        SystemParameters& system);

/// Adds the defaults that were taken, and what tells the given files from others.
void resolve_sectors(const SystemParameters& system, nlohmann::ordered_json& section);

}  // namespace arcslip
