#include "cases/key_catalogue.hpp"

#include <fmt/format.h>

#include "cases/branch_section.hpp"
#include "cases/continuation_section.hpp"
#include "cases/cycles_section.hpp"
#include "cases/element_section.hpp"
#include "cases/excitation_section.hpp"
#include "cases/flutter_section.hpp"
#include "cases/model_section.hpp"
#include "cases/ring_section.hpp"
#include "cases/structure_kind.hpp"
#include "cases/study_section.hpp"
#include "cases/system_section.hpp"

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

/// The keys of all kinds, of which the first ones, from `kind` on, are shared and told once.
template <class Kind, class KeysOf>
std::vector<KeyWords> words_of_kinds(const std::vector<Kind>& kinds, std::ptrdiff_t shared,
                                     const char* meaning, const KeysOf& keys_of) {
  std::vector<KeyWords> words;
  std::vector<std::string> names;
  for (const Kind& kind : kinds) {
    const std::vector<KeyWords> keys = keys_of(kind).words();
    if (words.empty()) words.assign(keys.begin(), keys.begin() + shared);
    words.push_back({kind.name, fmt::format("kind = \"{}\"", kind.name), "", kind.meaning});
    for (auto own = keys.begin() + shared; own != keys.end(); ++own) {
      words.push_back(*own);
      words.back().name = kind.name + "." + own->name;
    }
    names.push_back(kind.name);
  }
  words.front().type = one_of(names);
  words.front().meaning = meaning;
  return words;
}

}  // namespace

std::vector<KeySection> key_catalogue() {
  std::vector<KeySection> sections;
  const auto section = [&](const std::string& name, const std::string& note,
                           const std::vector<KeyWords>& keys) {
    add(sections.emplace_back(KeySection{name, note, {}}).keys, keys, "",
        name == "system" || name == "geometry" || name == "flutter");
  };
  for (const StructureKind& kind : structure_kinds()) {
    section("system", kind.title, kind.keys());
    for (const StructureKind::Section& one : kind.sections) section(one.name, one.note, one.keys());
  }
  section("system", "models of the library", library_words());
  section("model", "a system of one's own, in place of `[system]`", model_words());
  section("element", "beside the contacts, any number of them",
          words_of_kinds(element_kinds(), shared_element_keys, "what it is", element_keys));
  sections.back().repeats = true;
  section("excitation", "the load",
          words_of_kinds(excitation_kinds(), 1, "what its course is", excitation_keys));
  section("flutter", "a flow round the base", flutter_words());
  section("ring", "all sectors in place of one", ring_words());
  section("branch", "", branch_keys().words());
  section("continuation", "", continuation_keys().words());
  section("cycles", "of flows by `[model]` or of the library", cycles_keys().words());
  section("study", "", study_keys().words());
  section("study.uncertain", "", uncertain_keys().words());
  return sections;
}

}  // namespace arcslip
