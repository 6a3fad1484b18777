#pragma once

// The keys of a table of a case file, each said once: how it is read and refused, what it is if it is not
// given, what it means. `arcslip help`, the manual, summary.json and for_each have it from here. To add a
// key, add a line to its table: name, member of the settings, what it may be, meaning, and what else is to be
// said of it by one of the terms below.
//
//   using K = Key<TraceOptions>;
//   static const KeyTable<TraceOptions> keys{{
//       K("max_step", &TraceOptions::max_step, up_to(1), "largest step", unit("scaled arclength")),
//       K("mass_ratio", &System::mass_ratio, positive(), "M*", required), ...}};
//
// A key that is not given leaves the settings as they are: what they are at first is its default. Keys are
// read in their order, so that what one may be can depend on those before it.

#include <fmt/format.h>

#include <cmath>
#include <concepts>
#include <nlohmann/json.hpp>
#include <optional>
#include <type_traits>
#include <utility>

#include "keys/toml_reader.hpp"

namespace arcslip {

/// What is told of a key.
struct KeyWords {
  std::string name;
  std::string type;                  ///< as "number"
  std::string allowed;               ///< completes the type, as " > 0"
  std::string meaning;               ///< on one line
  std::string otherwise = {};        ///< what it is if not given: a value, "required", or in words
  std::string condition = {};        ///< where it may be given, as "only beside curve"
  std::string unit = {};             ///< "" of plain numbers
  std::string parameter = {};        ///< the name under which it may be continued, if it may
  bool is_listed = true;             ///< of [system] and [geometry]: whether for_each may list it
  std::vector<KeyWords> inner = {};  ///< of a table
};

/// A key that for_each may list, with the path of its value in the file.
struct ListedKey {
  std::string name;  ///< dotted where it stands in a table of its own
  std::string path;
  std::string parameter = {};  ///< the name under which it may be continued
};

/// Those among the keys of a section.
std::vector<ListedKey> listed_keys(const std::vector<KeyWords>& keys, const std::string& section);

/// Adds what an object lacks, in tables as well.
void fill(nlohmann::ordered_json& object, const nlohmann::ordered_json& values);

template <class T>
using Choices = std::vector<std::pair<std::string, T>>;

/// A value as JSON; null where there is none.
template <class T>
nlohmann::ordered_json json_of(const T& value) {
  if constexpr (std::is_floating_point_v<T>) {
    if (!std::isfinite(value)) return nullptr;
  }
  return value;
}
template <class T>
nlohmann::ordered_json json_of(const std::optional<T>& value) {
  return value ? json_of(*value) : nlohmann::ordered_json();
}

template <class S>
class KeyTable;

/// A key that is read into settings S. `Member` is a pointer to a member of S, or anything else that gives a
/// reference when it is invoked with S; `Term` is one of those below.
template <class S>
struct Key {
  using Json = nlohmann::ordered_json;
  using Reader = std::function<void(S&, const TomlSection&)>;
  using Condition = std::function<bool(const S&, const TomlSection&)>;
  template <class Member>
  using Value = std::remove_cvref_t<std::invoke_result_t<Member, S&>>;

  /// What a number may be, which may depend on what was read before it; help has `text` of such.
  struct Rule {
    Rule(NumberRule rule) : fixed(std::move(rule)) {}
    Rule(const std::string& text, std::function<NumberRule(const S&)> rule)
        : fixed{{}, text}, of(std::move(rule)) {}
    NumberRule fixed;
    std::function<NumberRule(const S&)> of = {};  ///< null: the fixed one holds
  };

  /// A number, an integer or a list of numbers, as the member is.
  template <class Member, class... Term>
  Key(const std::string& name, Member member, const Rule& rule, const std::string& meaning,
      const Term&... term) {
    using T = Value<Member>;
    const auto get = [] {
      if constexpr (std::is_integral_v<T>) {
        return std::pair("integer", &TomlSection::integer);
      } else if constexpr (std::is_same_v<T, std::vector<double>>) {
        return std::pair("list of numbers", &TomlSection::numbers);
      } else {
        return std::pair("number", &TomlSection::number);
      }
    }();
    words = {name, get.first, rule.fixed.text, meaning};
    read = [=](S& settings, const TomlSection& section) {
      const auto set = [&](const NumberRule& allowed) {
        std::invoke(member, settings) = static_cast<T>((section.*get.second)(name, allowed));
      };
      rule.of ? set(rule.of(settings)) : set(rule.fixed);
    };
    value = [=](const S& settings) { return json_of(std::invoke(member, settings)); };
    (term(*this), ...);
  }

  template <class Member, class... Term>
  static Key flag(const std::string& name, Member member, const std::string& meaning, const Term&... term) {
    const auto read = [=](S& settings, const TomlSection& section) {
      std::invoke(member, settings) = section.boolean(name);
    };
    const auto value = [=](const S& settings) -> Json { return std::invoke(member, settings); };
    return Key({name, "true or false", "", meaning}, read, value, term...);
  }

  /// One of settings that S is derived from.
  template <class Base>
  requires(std::derived_from<S, Base> && !std::same_as<S, Base>) Key(const Key<Base>& key)
      : words(key.words), read(key.read), value(key.value), is_needed(key.is_needed), then(key.then) {
    for (const auto& [text, holds] : key.only) only.emplace_back(text, holds);
  }

  /// One of some names; `remark` follows them in messages.
  template <class Member, class... Term>
  static Key choice(const std::string& name, Member member, const Choices<Value<Member>>& choices,
                    const std::string& meaning, const std::string& remark, const Term&... term) {
    std::vector<std::string> names;
    for (const auto& choice : choices) names.push_back(choice.first);
    const auto read = [=](S& settings, const TomlSection& section) {
      const std::string given = section.text(name, names, remark);
      for (const auto& [text, chosen] : choices) {
        if (text == given) std::invoke(member, settings) = chosen;
      }
    };
    const auto value = [=](const S& settings) -> Json {
      for (const auto& [text, chosen] : choices) {
        if (chosen == std::invoke(member, settings)) return text;
      }
      return nullptr;
    };
    return Key({name, one_of(names), remark, meaning}, read, value, term...);
  }

  /// One that has a table of keys of its own, in messages `missing` or, where it is none, `table`.
  template <class Member, class... Term>
  static Key table(const std::string& name, Member member, const KeyTable<Value<Member>>& keys,
                   const std::string& missing, const std::string& table, const std::string& meaning,
                   const Term&... term) {
    const auto read = [=, &keys](S& settings, const TomlSection& section) {
      section.require(name, missing);
      keys.read(std::invoke(member, settings), section.inside(name, table));
    };
    const auto value = [=, &keys](const S& settings) { return keys.values(std::invoke(member, settings)); };
    Key key({name, "table", "", meaning}, read, value, term...);
    key.words.inner = keys.words();
    return key;
  }

  /// Any other, by what reads it; null of one that is read elsewhere.
  template <class... Term>
  static Key special(const std::string& name, const std::string& type, const std::string& meaning,
                     const Reader& read, const Term&... term) {
    return Key({name, type, "", meaning}, read, {}, term...);
  }

  /// With its default.
  KeyWords told() const {
    KeyWords told = words;
    if (!told.otherwise.empty() || !told.inner.empty() || !value) return told;
    const Json standard = value(S{});
    if (standard.is_number_float()) {
      told.otherwise = fmt::format("{}", standard.template get<double>());
    } else if (!standard.is_null()) {
      told.otherwise = standard.dump();
    }
    return told;
  }

  /// Reads it where it is given or must be. Throws InputError.
  void read_from(const TomlSection& section, S& settings) const {
    const bool is_given = section.has(words.name);
    for (const auto& [text, holds] : only) {
      if (holds(settings, section)) continue;
      if (is_given) section.fail(words.name, text);
      return;
    }
    if (!read || (!is_given && !(is_needed && is_needed(settings, section)))) return;
    read(settings, section);
    if (then) then(settings, section);
  }

  KeyWords words;
  Reader read;
  std::function<Json(const S&)> value;  ///< what summary.json has where it is not given; null: nothing
  Condition is_needed = {};             ///< null: never
  std::vector<std::pair<std::string, Condition>> only = {};  ///< what must hold, and what is said if not
  Reader then = {};                                          ///< done after it was read

 private:
  template <class... Term>
  Key(KeyWords said, Reader reader, std::function<Json(const S&)> standard, const Term&... term)
      : words(std::move(said)), read(std::move(reader)), value(std::move(standard)) {
    (term(*this), ...);
  }
};

/// Keys of settings that S is derived from.
template <class S, class Base>
std::vector<Key<S>> keys_of(const std::vector<Key<Base>>& keys) {
  return {keys.begin(), keys.end()};
}

// Terms, which a key may have after its meaning.

/// It must be given where the condition holds, and has no default then.
template <class Condition>
auto needed(const std::string& text, const Condition& condition) {
  return [=](auto& key) {
    key.is_needed = condition;
    key.value = {};
    key.words.otherwise = text;
  };
}
inline constexpr auto always = [](const auto&, const TomlSection&) { return true; };
inline const auto required = needed("required", always);

/// The condition that a section has none of these keys.
template <class... Name>
auto lacks(const Name&... name) {
  return [=](const auto&, const TomlSection& section) { return (!section.has(name) && ...); };
}

/// Where the condition does not hold it is refused with this text; help has `told` of it.
template <class Condition>
auto only(const std::string& text, const Condition& condition, const std::string& told) {
  return [=](auto& key) {
    key.words.condition += (key.words.condition.empty() || told.empty() ? "" : "; ") + told;
    key.only.emplace_back(text, condition);
  };
}
template <class Condition>
auto only(const std::string& text, const Condition& condition) {
  return only(text, condition, text);
}

/// Done after it was read, as a check.
template <class Reader>
auto then(const Reader& reader) {
  return [=](auto& key) { key.then = reader; };
}

/// What summary.json has where it is not given.
template <class Value>
auto resolved(const Value& value) {
  return [=](auto& key) { key.value = value; };
}

/// What it is if not given, in words.
inline auto otherwise(const std::string& text) {
  return [=](auto& key) { key.words.otherwise = text; };
}
inline auto unit(const std::string& text) {
  return [=](auto& key) { key.words.unit = text; };
}
/// It may be continued under this name.
inline auto parameter(const std::string& name) {
  return [=](auto& key) { key.words.parameter = name; };
}
/// for_each may not list it.
inline constexpr auto unlisted = [](auto& key) { key.words.is_listed = false; };
/// Its default is nothing that summary.json has.
inline constexpr auto unresolved = [](auto& key) { key.value = {}; };

/// Where S has a member of one of its members.
template <class Outer, class Inner>
auto at(Outer outer, Inner inner) {
  return [=](auto& settings) -> auto& { return settings.*outer.*inner; };
}

template <class S>
class KeyTable {
 public:
  /// Of keys one after the other, some of which may be shared with other tables.
  using Keys = std::vector<Key<S>>;
  KeyTable(Keys first, const Keys& second = {}, const Keys& third = {}) : keys_(std::move(first)) {
    for (const Keys* more : {&second, &third}) keys_.insert(keys_.end(), more->begin(), more->end());
    for (const Key<S>& key : keys_) names_.push_back(key.words.name);
  }

  const std::vector<std::string>& names() const { return names_; }

  /// Refuses other keys, then reads those that there are. Throws InputError.
  void read(S& settings, const TomlSection& section) const {
    section.allow_only(names_);
    for (const Key<S>& key : keys_) key.read_from(section, settings);
  }

  /// Reads one alone.
  void read(const std::string& name, S& settings, const TomlSection& section) const {
    for (const Key<S>& key : keys_) {
      if (key.words.name == name) key.read_from(section, settings);
    }
  }

  /// The values by key, but for those that have none.
  nlohmann::ordered_json values(const S& settings) const {
    nlohmann::ordered_json values = nlohmann::ordered_json::object();
    for (const Key<S>& key : keys_) {
      nlohmann::ordered_json value = key.value ? key.value(settings) : nullptr;
      if (!value.is_null()) values[key.words.name] = std::move(value);
    }
    return values;
  }

  std::vector<KeyWords> words() const {
    std::vector<KeyWords> words;
    for (const Key<S>& key : keys_) words.push_back(key.told());
    return words;
  }

 private:
  Keys keys_;
  std::vector<std::string> names_;
};

}  // namespace arcslip
