#pragma once

// The section [flutter] of a case file: what a flow does to the base.

#include <string>
#include <vector>

#include "arcslip/cases/case_file.hpp"
#include "cases/structure_kind.hpp"
#include "keys/key_table.hpp"

namespace arcslip {

/// Its keys.
std::vector<KeyWords> flutter_words();

/// Puts what the section says into the request's system, if it is given. Throws InputError.
void read_flutter(const TomlDocument& document, const Replacements& replacements, const SystemUse& use,
                  ProblemRequest& problem);

/// What for_each may list of it.
std::vector<ListedKey> listed_flutter_keys(const TomlDocument& document);

/// Defaults in the place of keys that are not given, and what files held in that of their names.
void resolve_flutter(const SystemParameters& system, nlohmann::ordered_json& section);

/// What is said of it, on a line of its own; "" without.
std::string flutter_in_words(const SystemParameters& system);

}  // namespace arcslip
