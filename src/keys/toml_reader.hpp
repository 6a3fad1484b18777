#pragma once

// Typed access to a TOML document with errors that name file, line, column, key, what was expected and what
// was given. Values may be replaced by their dotted path, as `--set` and `for_each` do.

// Where what it asserts does not hold, as in "[[[", the parser says itself what is wrong with the text.
#define TOML_ASSERT(condition) static_cast<void>(0)
#include <toml++/toml.h>

#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "arcslip/keys/input_error.hpp"
#include "arcslip/types.hpp"

namespace arcslip {

constexpr std::size_t longest_name = 120;  ///< as messages show it, of a key or a setting
constexpr std::size_t longest_text = 60;

/// The number that a node holds, to the last digit; none where it holds no number, or an integer that no
/// double equals.
std::optional<double> exact_number(const toml::node& node);

/// A value that takes the place of another, with the name it goes by in errors.
struct Replacement {
  const toml::node* node;
  std::string name;
  const toml::node* place = nullptr;  ///< what errors point to in the file; null: the node
};

struct CaseParts;

using Replacements = std::map<std::string, Replacement, std::less<>>;

/// What a number must satisfy; `text` completes "expected a number ...".
struct NumberRule {
  std::function<bool(double)> holds;
  std::string text;
};

NumberRule any_number();
NumberRule positive();
NumberRule inside(double low, double high);                                ///< between the two
NumberRule within(double low, double high, const std::string& text = "");  ///< or equal to one of them
NumberRule at_least(double low, double high = std::numeric_limits<double>::max());  ///< `high` is not said
NumberRule up_to(double high);                                                      ///< > 0 and no more

/// A file's table and the settings on top of it.
class TomlDocument {
 public:
  TomlDocument(const std::string& path, const std::vector<std::string>& settings);
  /// A text that is in no file; `name` stands for the file in errors, `parts` are what it may name.
  TomlDocument(std::string name, const std::string& text, const std::vector<std::string>& settings,
               std::shared_ptr<const CaseParts> parts = {});

  const toml::table& root() const { return root_; }
  const std::string& path() const { return path_; }
  const CaseParts* parts() const { return parts_.get(); }  ///< null where there are none

  /// Error at a node; `name` is the key as the user wrote it.
  [[noreturn]] void fail(const toml::node* node, const std::string& name, const std::string& what) const;
  /// "expected ..., got ...", at the node or at `place`.
  [[noreturn]] void mismatch(const toml::node& node, const std::string& name, const std::string& expected,
                             const toml::node* place = nullptr) const;

  /// A value that must be a finite number within a rule.
  double number(const Replacement& value, const NumberRule& rule) const;

 private:
  void apply(const std::string& setting);

  std::string path_;
  toml::table root_;
  std::shared_ptr<const CaseParts> parts_;
};

/// One table of the document.
class TomlSection {
 public:
  TomlSection(const TomlDocument& document, std::string path, const Replacements* replacements = nullptr);
  /// A table that no path leads to, in an array.
  TomlSection(const TomlDocument& document, const toml::table& table, std::string path,
              const Replacements* replacements = nullptr)
      : document_(document), path_(std::move(path)), replacements_(replacements), table_(&table) {}

  bool has(std::string_view key) const { return node(key) != nullptr; }
  double number(std::string_view key, const NumberRule& rule) const;
  Index integer(std::string_view key, const NumberRule& rule) const;
  /// One of the choices, unless these are empty; `remark` follows them in messages.
  std::string text(std::string_view key, const std::vector<std::string>& choices,
                   const std::string& remark = "") const;
  bool boolean(std::string_view key) const;
  std::vector<double> numbers(std::string_view key, const NumberRule& rule) const;
  /// Two numbers, 0 < low < high, which are `expected`.
  std::pair<double, double> rising(std::string_view key, const std::string& expected) const;
  /// An array of names, each among the choices unless these are empty.
  std::vector<std::string> texts(std::string_view key, const std::vector<std::string>& choices,
                                 const std::string& expected) const;

  /// The table that a key holds, which is `expected`.
  TomlSection inside(std::string_view key, const std::string& expected) const;

  /// Refuses every key that is not among these.
  void allow_only(const std::vector<std::string>& keys) const;

  [[noreturn]] void fail(std::string_view key, const std::string& what) const;
  [[noreturn]] void mismatch(std::string_view key, const std::string& expected) const;
  const toml::node& require(std::string_view key, const std::string& expected) const;
  const toml::table* table() const { return table_; }
  const TomlDocument& document() const { return document_; }
  std::string name(std::string_view key) const;
  /// The name under which the user wrote the value, elsewhere if it is replaced.
  std::string name_given(std::string_view key) const { return find(key).name; }

 private:
  const Replacement* replaced(std::string_view key) const;
  const toml::node* node(std::string_view key) const;
  Replacement find(std::string_view key) const;

  const TomlDocument& document_;
  std::string path_;
  const Replacements* replacements_;
  const toml::table* table_ = nullptr;
};

/// The same value as JSON.
nlohmann::ordered_json to_json(const toml::node& node);

/// "\"a\" or \"b\"".
std::string one_of(const std::vector<std::string>& choices);

/// What is said of a key that is not among `keys`: which one it was most likely meant to be, or all of them.
std::string unknown_key(std::string_view key, const std::vector<std::string>& keys);

/// The name among `names` that `name` was most likely meant to be, or "".
std::string nearest_name(std::string_view name, const std::vector<std::string>& names);

}  // namespace arcslip
