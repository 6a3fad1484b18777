#include "cases/key_catalogue.hpp"

#include <fmt/format.h>

#include "cases/branch_section.hpp"
#include "cases/continuation_section.hpp"
#include "cases/geometry_section.hpp"
#include "cases/sector_section.hpp"
#include "cases/study_section.hpp"

namespace arcslip {
namespace {

/// A table that for_each lists it lists as a whole.
void add(std::vector<KeyWords>& keys, const std::vector<KeyWords>& more, const std::string& prefix,
         bool are_listed) {
  for (const KeyWords& key : more) {
    keys.push_back(key);
    keys.back().name = prefix + key.name;
    keys.back().is_listed = are_listed && key.is_listed;
    add(keys, key.inner, prefix + key.name + ".", are_listed && !key.is_listed);
  }
}

/// The settings of all models, each under its model's name.
std::vector<KeyWords> library_words() {
  std::vector<KeyWords> words;
  for (const problems::LibraryModel& model : problems::library()) {
    std::vector<KeyWords> keys = library_keys(model).words();
    keys.front() = {model.name, fmt::format("model = \"{}\"", model.name), "", model.title};
    for (KeyWords& key : keys)
      if (key.name != model.name) key.name = model.name + "." + key.name;
    words.insert(words.end(), keys.begin(), keys.end());
  }
  return words;
}

}  // namespace

std::vector<KeySection> key_catalogue() {
  std::vector<KeySection> sections;
  const auto section = [&](const char* name, const char* note, const std::vector<KeyWords>& keys) {
    add(sections.emplace_back(KeySection{name, note, {}}).keys, keys, "",
        name == std::string("system") || name == std::string("geometry"));
  };
  section("system", "rods and beams", ring_keys().words());
  section("geometry", "two rings in SI units", geometry_keys().words());
  section("system", "sectors", sector_keys().words());
  section("system.base", "and of `[system.damper]`", part_keys(true).words());
  section("system", "models of the library", library_words());
  section("branch", "", branch_keys().words());
  section("continuation", "", continuation_keys().words());
  section("study", "", study_keys().words());
  section("study.uncertain", "", uncertain_keys().words());
  return sections;
}

}  // namespace arcslip
