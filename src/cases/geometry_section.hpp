#pragma once

// The section [geometry] of a case file: base and damper in SI units, in place of most of [system].

#include "arcslip/cases/case_file.hpp"
#include "keys/toml_reader.hpp"

namespace arcslip {

/// Whether the case has the section.
bool has_geometry(const TomlDocument& document);

/// Refuses keys that it does not have.
void check_geometry_keys(const TomlDocument& document);

/// Its values by their dotted names, as "preload_per_length" and "damper.width".
std::vector<std::string> geometry_keys();

/// Reads the section and sets with it what `problem.system`, whose model is known, need not have from
/// [system]: `system` must not set it too, but for interface_stiffness. `parameter` is the continuation
/// parameter: where it is P, the preload may be left out. Throws InputError.
void read_geometry(const TomlDocument& document, const Replacements& replacements, const TomlSection& system,
                   const std::string& parameter, ProblemRequest& problem);

}  // namespace arcslip
