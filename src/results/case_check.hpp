#pragma once

// What `arcslip check` says of a case file: what would run, and whether its problems' derivatives are exact.

#include <string>
#include <vector>

#include "arcslip/cases/case_file.hpp"

namespace arcslip {

struct CaseCheck {
  std::string text;                        ///< lines
  std::vector<std::string> warnings = {};  ///< those among them, without what announces them
  bool good = true;                        ///< whether all derivatives that were compared are exact
};

/// Reads and validates all of it; compares derivatives only if asked to. Throws InputError.
CaseCheck check_case(const CaseFile& file, bool derivatives);

}  // namespace arcslip
