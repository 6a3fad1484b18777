#pragma once

// Texts from outside as a terminal may show them: keys, strings and names of files can hold anything.

#include <string>
#include <string_view>

namespace arcslip {

/// The text on one line. Control characters, signs that turn the direction of writing, and bytes that are no
/// UTF-8 become escapes: "\n", "\x1b", "\u202e". Of a text of more than `longest` bytes the beginning, and
/// how long it is.
std::string printable(std::string_view text, std::size_t longest = std::string_view::npos);

}  // namespace arcslip
