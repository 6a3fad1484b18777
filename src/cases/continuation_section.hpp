#pragma once

// The section [continuation] of a case file.

#include "arcslip/continuation/path/trace.hpp"
#include "keys/toml_reader.hpp"

namespace arcslip {

/// Reads the section but for `stop_at`, whose values belong to the range that [branch] or [study] gives.
continuation::TraceOptions read_continuation(const TomlDocument& document);

/// Adds the defaults that were taken to the section as JSON.
void resolve_continuation(const continuation::TraceOptions& options, nlohmann::ordered_json& section);

}  // namespace arcslip
