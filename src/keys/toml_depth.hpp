#pragma once

// How deep the keys of a TOML text nest: tables within tables are taken down one within the other.

#include <string_view>

namespace arcslip {

constexpr int deepest_key = 256;  ///< as deep as values may nest

/// The number of the first line with a dotted key of more parts; 0 if there is none.
long line_nested_too_deep(std::string_view text);

}  // namespace arcslip
