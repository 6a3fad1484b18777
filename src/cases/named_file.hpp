#pragma once

// Files that keys of a case file name.

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

#include "arcslip/sectors/matrix_market.hpp"
#include "keys/input_file.hpp"
#include "keys/toml_reader.hpp"

namespace arcslip {

/// A file's text and the path that messages call it by.
struct NamedText {
  std::string text;
  std::string path;
};

/// What the file that the key names holds, or the text that a program gives under this name. Names start from
/// the folder of the case file. The fingerprint, if there is one, takes in all bytes. Throws InputError.
NamedText read_named(const TomlSection& section, std::string_view key, std::size_t largest,
                     std::uint64_t* fingerprint,
                     const std::function<void(std::string_view, const std::string&)>& begins = {});

/// `parse` of its text and its path. Throws InputError, also in place of MatrixTextError.
template <class Parse>
auto parsed(const TomlSection& section, std::string_view key, std::size_t largest, std::uint64_t* fingerprint,
            const Parse& parse,
            const std::function<void(std::string_view, const std::string&)>& begins = {}) {
  const NamedText named = read_named(section, key, largest, fingerprint, begins);
  try {
    return parse(named.text, named.path);
  } catch (const MatrixTextError& error) {
    section.fail(key, error.what());
  } catch (const std::bad_alloc&) {
    section.fail(key, named.path + ": there is not enough memory for it");
  }
}

}  // namespace arcslip
