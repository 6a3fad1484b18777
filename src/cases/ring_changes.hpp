#pragma once

// What the tables [[ring.mistuning]] and [[ring.cut]] of a case file change in single sectors.

#include <vector>

#include "arcslip/assembly/whole_ring.hpp"
#include "cases/output_weights.hpp"

namespace arcslip {

/// One of these tables.
struct RingChangeSettings {
  bool on_base = true;               ///< or on the damper
  std::vector<double> dofs = {};     ///< of a sector, from 1; without them elements of rods and beams change
  std::vector<double> weights = {};  ///< of the dofs of a cut, in what its link is stretched by
  double stiffness = 0;              ///< of a spring between two of them, or from one to ground
  double mass = 0;                   ///< of one
  std::vector<double> factors = {};  ///< of a mistuning, on these in each sector
  std::vector<Index> after = {};     ///< of a cut: behind which sectors, from 0
  Index pattern = 1;                 ///< which a scatter gives
  Index sectors = 0;                 ///< N, known beforehand
  Index size = 0;                    ///< dofs that there are, the same; 0: not known
  bool has_elements = false;         ///< whether they are rods and beams
};

/// Their keys.
const KeyTable<RingChangeSettings>& mistuning_keys();
const KeyTable<RingChangeSettings>& cut_keys();

/// Motions of a sector's base or damper that the tables change, of so many dofs, in their order. Throws
/// InputError.
std::vector<WeightRow> changed_motions(const TomlDocument& document, bool on_base, Index size);

/// Adds all changes to a ring, scattered ones of one pattern, and what rods and beams are asked for. Throws
/// InputError.
void read_changes(const TomlDocument& document, const SystemParameters& system, Index pattern,
                  RingMake& ring);

}  // namespace arcslip
