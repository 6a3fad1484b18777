#pragma once

// What a branch may not ask for together.

#include "arcslip/cases/case_file.hpp"
#include "keys/toml_reader.hpp"

namespace arcslip {

/// Refuses in [system] what is not made for harmonics that are not odd, and in [branch] curves of switches of
/// responses over several periods.
void check_even(const TomlSection& section, const TomlSection& branch_section, const CaseBranch& branch);

/// Refuses in [branch] what does not go over the resonances over which an amplification is told.
void check_amplification(const TomlSection& section, const CaseBranch& branch);

/// Refuses in [branch] stability of what has no exponents.
void check_stability(const TomlSection& section, const CaseBranch& branch);

}  // namespace arcslip
