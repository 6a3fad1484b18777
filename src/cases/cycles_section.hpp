#pragma once

// The section [cycles] of a case file: how the cycles of flows are followed.

#include "arcslip/cases/case_file.hpp"
#include "keys/key_table.hpp"

namespace arcslip {

/// All keys of the section.
const KeyTable<CaseBranch>& cycles_keys();

}  // namespace arcslip
