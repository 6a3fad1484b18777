#pragma once

// The section [excitation] of a case file: the course of the load, of the kinds of excitation.hpp.

#include "arcslip/assembly/excitation.hpp"
#include "keys/key_table.hpp"

namespace arcslip {

/// The keys of one kind; the first one is `kind`.
const KeyTable<Excitation>& excitation_keys(const ExcitationKind& kind);

/// What the section says; a sine where there is none. Throws InputError.
Excitation read_excitation(const TomlDocument& document, const Replacements& replacements);

/// What for_each may list of it.
std::vector<ListedKey> listed_excitation_keys(const TomlDocument& document);

}  // namespace arcslip
