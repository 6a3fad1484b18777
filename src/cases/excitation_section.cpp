#include "cases/excitation_section.hpp"

#include <fmt/format.h>

#include <map>

#include "cases/element_section.hpp"

namespace arcslip {
namespace {

KeyTable<Excitation> keys_of(const ExcitationKind& kind) {
  using E = Key<Excitation>;
  std::vector<E> keys{E::special("kind", fmt::format("\"{}\"", kind.name), kind.meaning, {},
                                 otherwise("\"travelling\""), unlisted)};
  for (std::size_t i = 0; i < kind.settings.size(); ++i) {
    const Setting& setting = kind.settings[i];
    const auto value = [i](auto& excitation) -> auto& { return excitation.settings[i]; };
    keys.push_back(E(setting.name, value, rule_of(setting), setting.meaning,
                     otherwise(fmt::format("{}", setting.value))));
  }
  return {std::move(keys)};
}

const ExcitationKind& course_of(const TomlSection& section) {
  std::vector<std::string> names;
  for (const ExcitationKind& kind : excitation_kinds()) names.push_back(kind.name);
  return *find_excitation_kind(section.has("kind") ? section.text("kind", names) : "travelling");
}

}  // namespace

const KeyTable<Excitation>& excitation_keys(const ExcitationKind& kind) {
  static const auto tables = [] {
    std::map<std::string, KeyTable<Excitation>> made;
    for (const ExcitationKind& one : excitation_kinds()) made.emplace(one.name, keys_of(one));
    return made;
  }();
  return tables.at(kind.name);
}

Excitation read_excitation(const TomlDocument& document, const Replacements& replacements) {
  const TomlSection section(document, "excitation", &replacements);
  if (section.table() == nullptr) return {};
  Excitation excitation{&course_of(section), {}};
  for (const Setting& setting : excitation.kind->settings) excitation.settings.push_back(setting.value);
  excitation_keys(*excitation.kind).read(excitation, section);
  return excitation;
}

std::vector<ListedKey> listed_excitation_keys(const TomlDocument& document) {
  const TomlSection section(document, "excitation");
  if (section.table() == nullptr) return {};
  return listed_keys(excitation_keys(course_of(section)).words(), "excitation");
}

}  // namespace arcslip
