#include "cases/named_file.hpp"

#include <filesystem>
#include <new>

#include "arcslip/cases/case_file.hpp"

namespace arcslip {
namespace {

/// The folder of a case file, which the names of other files start from. One in a pipe has none.
std::string folder_of(const std::string& path) {
  const std::filesystem::path folder = std::filesystem::path(path).parent_path();
  return folder == "/dev" || folder == "/dev/fd" || folder == "/proc/self/fd" ? "" : folder.string();
}

/// The text that a program gives under this name, or null.
const std::string* given_text(const TomlDocument& document, const std::string& name) {
  if (document.parts() == nullptr) return nullptr;
  const auto found = document.parts()->files.find(name);
  return found == document.parts()->files.end() ? nullptr : &found->second;
}

}  // namespace

NamedText read_named(const TomlSection& section, std::string_view key, std::size_t largest,
                     std::uint64_t* fingerprint,
                     const std::function<void(std::string_view, const std::string&)>& begins) {
  const std::string name = section.text(key, {});
  const TomlDocument& document = section.document();
  NamedText named{{}, name};
  try {
    if (const std::string* given = given_text(document, name)) {
      named.text = *given;
    } else {
      named.path = (std::filesystem::path(folder_of(document.path())) / name).string();
      named.text = read_text(named.path, largest, [&](std::string_view beginning) {
        if (begins) begins(beginning, named.path);
      });
    }
  } catch (const InputError& error) {
    section.fail(key, error.what());
  } catch (const MatrixTextError& error) {
    section.fail(key, error.what());
  } catch (const std::bad_alloc&) {
    section.fail(key, named.path + ": there is not enough memory for it");
  }
  if (fingerprint == nullptr) return named;
  for (const char c : named.text) {  // FNV-1a
    *fingerprint ^= static_cast<unsigned char>(c);
    *fingerprint *= 1099511628211U;
  }
  return named;
}

}  // namespace arcslip
