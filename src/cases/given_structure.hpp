#pragma once

// [system] of a structure that a program gives by its responses: its name as `model`.

#include "cases/structure_kind.hpp"

namespace arcslip {

/// What all of them are; no case file can name one.
const StructureKind& given_structure();

/// The one that a document's parts have under this name, or null.
std::shared_ptr<const Structures> find_given(const TomlDocument& document, const std::string& model);

}  // namespace arcslip
