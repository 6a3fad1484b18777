#include "cases/excitation_section.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <map>

#include "cases/element_section.hpp"
#include "cases/named_file.hpp"
#include "cases/output_weights.hpp"
#include "keys/printable.hpp"

namespace arcslip {
namespace {

/// The numbers of a text, between blanks, commas and ends of lines, behind # none.
std::vector<double> numbers_of(std::string_view text, const std::string& file) {
  std::vector<double> all;
  for (std::size_t line = 1; !text.empty(); ++line) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    std::string_view rest = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    rest = rest.substr(0, rest.find('#'));
    constexpr std::string_view between = " \t\r,;";
    for (rest.remove_prefix(std::min(rest.find_first_not_of(between), rest.size())); !rest.empty();
         rest.remove_prefix(std::min(rest.find_first_not_of(between), rest.size()))) {
      const std::string_view word = rest.substr(0, rest.find_first_of(between));
      double& value = all.emplace_back();
      const auto [last, error] = std::from_chars(word.data(), word.data() + word.size(), value);
      if (error != std::errc() || last != word.data() + word.size() || !std::isfinite(value))
        throw MatrixTextError(fmt::format("{}:{}: expected finite numbers, got {}", file, line,
                                          printable(std::string(word), 40)));
      rest.remove_prefix(word.size());
    }
  }
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
    value(excitation) = section.require(name, "").is_string()
                            ? parsed(section, name, largest_list, nullptr, numbers_of)
                            : section.numbers(name, rule);
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
