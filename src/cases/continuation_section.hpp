#pragma once

// The section [continuation] of a case file.

#include "arcslip/continuation/path/trace.hpp"
#include "keys/key_table.hpp"

namespace arcslip {

/// Its keys. The range of the options, to which `stop_at` belongs, is that of [branch] or [study].
const KeyTable<continuation::TraceOptions>& continuation_keys();

}  // namespace arcslip
