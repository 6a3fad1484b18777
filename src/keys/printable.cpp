#include "keys/printable.hpp"

#include <fmt/format.h>

#include <array>
#include <cstdint>
#include <iterator>

namespace arcslip {
namespace {

/// A character of a text: how many bytes it takes, and its number; a byte that begins none has a number
/// beyond all.
struct Character {
  static constexpr std::uint32_t none = 0x110000;
  std::size_t bytes = 1;
  std::uint32_t number = none;
};

/// The first character of a text that is not empty [RFC 3629].
Character first_of(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  if (byte(0) < 0x80) return {1, byte(0)};
  const std::size_t bytes = byte(0) >= 0xf0 ? 4 : byte(0) >= 0xe0 ? 3 : 2;
  if (byte(0) < 0xc2 || byte(0) > 0xf4 || text.size() < bytes) return {};
  std::uint32_t number = byte(0) & (0x7fU >> bytes);
  for (std::size_t i = 1; i < bytes; ++i) {
    if ((byte(i) & 0xc0U) != 0x80) return {};
    number = number << 6 | (byte(i) & 0x3fU);
  }
  constexpr std::array<std::uint32_t, 5> least = {0, 0, 0x80, 0x800, 0x10000};
  if (number < least.at(bytes) || number >= Character::none || (number >= 0xd800 && number < 0xe000))
    return {};
  return {bytes, number};
}

/// Whether a character moves, turns or breaks what stands about it.
bool is_control(std::uint32_t c) {
  return c < 0x20 || (c >= 0x7f && c < 0xa0) || c == 0x61c || (c >= 0x200b && c <= 0x200f) ||
         (c >= 0x2028 && c <= 0x202e) || (c >= 0x2060 && c <= 0x206f) || c == 0xfeff;
}

void append(std::string& text, const Character& character, std::string_view bytes) {
  const auto out = std::back_inserter(text);
  if (character.number == '\n') {
    text += "\\n";
  } else if (character.number == '\t') {
    text += "\\t";
  } else if (character.number == Character::none ||
             (character.number < 0x80 && is_control(character.number))) {
    fmt::format_to(out, "\\x{:02x}", static_cast<unsigned char>(bytes[0]));
  } else if (is_control(character.number)) {
    fmt::format_to(out, "\\u{:04x}", character.number);
  } else {
    text += bytes;
  }
}

}  // namespace

std::string printable(std::string_view text, std::size_t longest) {
  std::string shown;
  std::size_t taken = 0;
  while (taken < text.size() && taken < longest) {
    const Character character = first_of(text.substr(taken));
    append(shown, character, text.substr(taken, character.bytes));
    taken += character.bytes;
  }
  if (taken < text.size()) shown += fmt::format("... ({} bytes)", text.size());
  return shown;
}

}  // namespace arcslip
