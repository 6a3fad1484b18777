#pragma once

// Outputs of base and damper that are wanted beside their contacts: dofs of the key `output`, and of
// `weights` linear combinations of dofs, as a stress is.

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "arcslip/assembly/system.hpp"
#include "cases/sector_part.hpp"

namespace arcslip {

/// A linear combination of dofs, which count from 0.
struct WeightRow {
  std::string name;             ///< that it is given, or "w" and its number in a file
  std::vector<Index> dofs;      ///< one or more
  std::vector<double> weights;  ///< of each
};

/// The dofs that a key lists, from 1 to `size`, as they count from 0. Throws InputError.
std::vector<Index> listed_dofs(const TomlSection& section, std::string_view key, Index size);

/// What `weights` of a section holds, a table or the name of a file, of so many dofs; in the fingerprint, if
/// there is one, the file. A row of it is a name, which may be left out, and `size` numbers between commas;
/// what follows # on a line is a comment. Refuses names that are taken or could be another column's. Throws
/// InputError.
std::vector<WeightRow> read_weights(const TomlSection& section, Index size, std::uint64_t* fingerprint);

/// Adds an output to a sector's part.
void add_combination(PartSettings& part, const WeightRow& row);

/// What is wanted of a structure whose dofs are few.
struct OutputSettings {
  Index dofs = 0;                          ///< how many it has
  std::vector<WantedOutput> outputs = {};  ///< their `on_base` is not set
};
std::vector<Key<OutputSettings>> output_keys();

/// Adds the outputs of base or damper to those of a system.
void want(std::vector<WantedOutput> outputs, bool on_base, SystemParameters& system);

}  // namespace arcslip
