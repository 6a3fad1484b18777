#pragma once

// The tables [[element]] of a case file: elements beside the contacts, of the kinds of element_kind.hpp.

#include "arcslip/assembly/system.hpp"
#include "keys/key_table.hpp"

namespace arcslip {

/// The keys of one kind; the first ones are those of all.
constexpr std::ptrdiff_t shared_element_keys = 3;
KeyTable<PlacedElement> element_keys(const ElementKind& kind);

/// Reads them into the system, whose structures are known. Throws InputError.
void read_elements(const TomlDocument& document, SystemParameters& system);

/// What a setting may be, as messages say it.
NumberRule rule_of(const Setting& setting);

}  // namespace arcslip
