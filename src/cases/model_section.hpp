#pragma once

// The section [model] of a case file: a system of one's own, by formulas, in place of [system].

#include <memory>

#include "arcslip/cases/case_file.hpp"
#include "keys/key_table.hpp"

namespace arcslip {

/// Whether a case has it.
bool has_model(const TomlDocument& document);

/// Its keys, for help.
std::vector<KeyWords> model_words();

/// Reads its formulas; their parameters have the values of the section. Throws InputError.
std::shared_ptr<const problems::LibraryModel> read_model_section(const TomlDocument& document);

/// The values of the parameters, of which `continued` may not be replaced. Throws InputError.
problems::LibraryModel::Values read_model_values(const TomlDocument& document,
                                                 const Replacements& replacements,
                                                 const problems::LibraryModel& model,
                                                 const std::string& continued);

/// What for_each may list: the parameters.
std::vector<ListedKey> listed_model_keys(const problems::LibraryModel& model);

/// Adds the defaults that were taken, and brings tables into the order of the file.
void resolve_model(const TomlDocument& document, nlohmann::ordered_json& section);

}  // namespace arcslip
