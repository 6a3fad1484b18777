#include "cases/excitation_section.hpp"

#include <fmt/format.h>

#include <cmath>
#include <map>

#include "cases/element_section.hpp"
#include "cases/ring_numbers.hpp"

namespace arcslip {
namespace {

/// All numbers of a file that a key names, row by row.
std::vector<double> numbers_of_file(const TomlSection& section, const std::string& key) {
  std::vector<double> all;
  for (const std::vector<double>& row : number_rows(section, key))
    all.insert(all.end(), row.begin(), row.end());
  return all;
}

/// What each number of a list may be.
NumberRule rule_of_each(const Setting& each) {
  const NumberRule any = rule_of(each);
  if (!each.is_integer) return any;
  return {[holds = any.holds](double x) { return holds(x) && x == std::floor(x); },
          " that are whole," + any.text};
}

Key<Excitation> key_of(const ListSetting& list, std::size_t i) {
  using E = Key<Excitation>;
  const Setting& each = list.each;
  const auto value = [i](auto& excitation) -> auto& { return excitation.lists[i]; };
  const auto needed = [text = list.otherwise](E& key) {
    text.empty() ? required(key) : otherwise(text)(key);
  };
  if (!list.may_be_file) return E(each.name, value, rule_of_each(each), each.meaning, needed, unlisted);
  const auto read = [value, name = each.name, rule = rule_of_each(each)](Excitation& excitation,
                                                                         const TomlSection& section) {
    value(excitation) =
        section.require(name, "").is_string() ? numbers_of_file(section, name) : section.numbers(name, rule);
  };
  return E::special(each.name, "list of numbers or file", each.meaning, read, needed,
                    resolved([value](const Excitation& excitation) { return json_of(value(excitation)); }),
                    unlisted);
}

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
  for (std::size_t i = 0; i < kind.lists.size(); ++i) keys.push_back(key_of(kind.lists[i], i));
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
  excitation.lists.resize(excitation.kind->lists.size());
  excitation_keys(*excitation.kind).read(excitation, section);
  if (excitation.kind->complaint) {
    if (const auto wrong = excitation.kind->complaint(excitation)) section.fail(wrong->key, wrong->what);
  }
  return excitation;
}

std::vector<ListedKey> listed_excitation_keys(const TomlDocument& document) {
  const TomlSection section(document, "excitation");
  if (section.table() == nullptr) return {};
  return listed_keys(excitation_keys(course_of(section)).words(), "excitation");
}

}  // namespace arcslip
