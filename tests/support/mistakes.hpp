#pragma once

// Wrong input, and what the message about it must say.

#include <concepts>
#include <string>

#include "arcslip/keys/input_error.hpp"
#include "catch.hpp"

namespace arcslip::testing {

inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
  text.replace(text.find(from), from.size(), to);
  return text;
}

/// The message of the InputError that `read` ends with.
template <std::invocable Read>
std::string error_of(const Read& read) {
  try {
    read();
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

/// A change to a case, and what its message must hold: where, which key, what was expected and given.
struct Mistake {
  std::string from, to, place, key, expected, given;
};

inline void check_message(const std::string& message, const Mistake& mistake) {
  INFO(message);
  CHECK_THAT(message, ContainsSubstring("case.toml" + mistake.place));
  CHECK_THAT(message, ContainsSubstring(mistake.key) && ContainsSubstring(mistake.expected) &&
                          ContainsSubstring(mistake.given));
  CHECK(message.find('\n') == std::string::npos);
}

}  // namespace arcslip::testing
