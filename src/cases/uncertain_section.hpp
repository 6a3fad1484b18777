#pragma once

// The section [study.uncertain] of a case file.

#include "arcslip/problems/ridges/uncertainty.hpp"
#include "keys/key_table.hpp"

namespace arcslip {

const KeyTable<problems::Uncertainty>& uncertain_keys();

}  // namespace arcslip
