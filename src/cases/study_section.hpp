#pragma once

// The section [study] of a case file.

#include "arcslip/cases/study_case.hpp"
#include "keys/key_table.hpp"

namespace arcslip {

/// Its keys, of which `for_each` is read by itself.
const KeyTable<StudyCase>& study_keys();

}  // namespace arcslip
