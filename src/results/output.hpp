#pragma once

// Standard output and error, and what goes wrong where something is written.

#include <stdexcept>
#include <string>
#include <string_view>

namespace arcslip {

/// A file or folder that could not be written; the message names it and the reason.
class OutputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Keeps files that are opened later from taking the place of a standard stream that is closed.
void keep_standard_streams();

/// Prints on standard output, at once, lines without control characters; a reader that has gone is no error.
/// Throws OutputError.
void print(std::string_view text);

/// Prints one line on standard error, whatever the message holds; where that cannot be written, nobody is
/// there to be told.
void complain(std::string_view message) noexcept;

}  // namespace arcslip
