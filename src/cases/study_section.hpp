#pragma once

// The sections [study] and [study.uncertain] of a case file.

#include "arcslip/cases/study_case.hpp"
#include "keys/key_table.hpp"

namespace arcslip {

/// The keys of [study], of which `for_each` is read by itself.
const KeyTable<StudyCase>& study_keys();
const KeyTable<problems::Uncertainty>& uncertain_keys();

}  // namespace arcslip
