#pragma once

// Text as wide as the terminal.

#include <string>

namespace arcslip {

/// Columns of the terminal that standard output is, from 60 to 120; 100 where it is none.
std::size_t terminal_width();

/// With lines broken at spaces to at most `width` columns. What follows of a line stands below its text:
/// below what comes after two or more spaces within it, else below its first word.
std::string wrapped(const std::string& text, std::size_t width = terminal_width());

/// With the lines of each paragraph in one, but for those that begin with a space.
std::string as_paragraphs(const std::string& text);

}  // namespace arcslip
