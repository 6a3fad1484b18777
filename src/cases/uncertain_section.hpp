#pragma once

// The section [study.uncertain] of a case file.

#include "arcslip/problems/ridges/uncertainty.hpp"
#include "keys/toml_reader.hpp"

namespace arcslip {

/// Whether the case has the section.
bool scatters(const TomlDocument& document);

/// Reads the section. Throws InputError.
problems::Uncertainty read_uncertainty(const TomlDocument& document);

/// Adds the defaults that were taken to the section as JSON.
void resolve_uncertainty(const problems::Uncertainty& uncertainty, nlohmann::ordered_json& section);

}  // namespace arcslip
