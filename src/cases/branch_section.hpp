#pragma once

// The section [branch] of a case file.

#include "arcslip/cases/case_file.hpp"
#include "keys/key_table.hpp"

namespace arcslip {

/// Its keys, of which `for_each` is read by itself, and `eta` for each branch.
const KeyTable<CaseBranch>& branch_keys();

/// Reads [branch] for a model, null for a system with friction, and [continuation], but for what `for_each`
/// may change. Throws InputError.
CaseBranch read_branch(const TomlDocument& document,
                       const std::shared_ptr<const problems::LibraryModel>& model);

}  // namespace arcslip
