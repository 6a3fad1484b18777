#pragma once

// The section [ring] of a case file, whose presence asks for the whole ring in place of one sector.

#include <string>
#include <vector>

#include "arcslip/cases/case_file.hpp"
#include "cases/structure_kind.hpp"
#include "keys/key_table.hpp"

namespace arcslip {

/// Its keys, with the tables in it.
std::vector<KeyWords> ring_words();

/// Puts the whole ring in the place of the request's one sector, where the section is given. Throws
/// InputError.
void read_ring(const TomlDocument& document, const Replacements& replacements, const SystemUse& use,
               ProblemRequest& problem);

/// What for_each may list of it, if it is given.
std::vector<ListedKey> listed_ring_keys(const TomlDocument& document);

/// The defaults that were taken.
nlohmann::ordered_json ring_values();

/// The request as that for one sector, which it is without [ring].
ProblemRequest of_one_sector(ProblemRequest problem);

/// What is said of the whole ring, on a line of its own; "" of one sector.
std::string ring_in_words(const SystemParameters& system);

}  // namespace arcslip
