#include "keys/toml_reader.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <sstream>

#include "keys/input_file.hpp"
#include "keys/printable.hpp"
#include "keys/toml_depth.hpp"

namespace arcslip {
namespace {

std::string shown(const toml::node& node) {
  if (node.is_table()) return "a table";
  if (const toml::array* array = node.as_array()) return array->empty() ? "an empty array" : "an array";
  if (const auto* value = node.as_string())
    return fmt::format("\"{}\"", printable(value->get(), longest_text));
  if (const auto* value = node.as_floating_point()) {
    const std::string digits = fmt::format("{}", value->get());
    return digits.find_first_not_of("-0123456789") == std::string::npos ? digits + ".0" : digits;
  }
  std::ostringstream out;
  node.visit([&](const auto& value) { out << value; });
  return out.str();
}

std::vector<std::string> split_path(const std::string& path) {
  std::vector<std::string> parts;
  for (std::size_t from = 0; from < path.size();) {
    const std::size_t end = std::min(path.find('.', from), path.size());
    parts.push_back(path.substr(from, end - from));
    from = end + 1;
  }
  return parts;
}

bool is_bare_word(const std::string& text) {
  return !text.empty() && std::all_of(text.begin(), text.end(), [](unsigned char c) {
    return std::isalnum(c) != 0 || c == '_' || c == '-';
  });
}

[[noreturn]] void refuse(const std::string& setting, const std::string& why) {
  throw InputError(fmt::format("--set {}: {}", printable(setting, longest_name), why));
}

/// The value of a setting as TOML; a bare word may go without quotes.
toml::table parse_value(const std::string& setting, const std::string& value) {
  toml::table table;
  try {
    if (line_nested_too_deep(value) == 0) table = toml::parse("value = " + value);
  } catch (const toml::parse_error&) {
    if (is_bare_word(value)) return toml::table{{"value", value}};
  }
  if (table.size() != 1)
    refuse(setting, fmt::format("'{}' is not a TOML value", printable(value, longest_text)));
  return table;
}

}  // namespace

std::optional<double> exact_number(const toml::node& node) {
  if (const auto* real = node.as_floating_point()) return real->get();
  const auto* integer = node.as_integer();
  if (integer == nullptr) return std::nullopt;
  const auto number = static_cast<double>(integer->get());
  const bool in_range = number < -static_cast<double>(std::numeric_limits<std::int64_t>::min());
  if (!in_range || static_cast<std::int64_t>(number) != integer->get()) return std::nullopt;
  return number;
}

namespace {

/// A node's number, where it is one that a rule allows.
std::optional<double> accepted(const toml::node& node, const NumberRule& rule) {
  const std::optional<double> number = exact_number(node);
  return number && std::isfinite(*number) && rule.holds(*number) ? number : std::nullopt;
}

}  // namespace

TomlDocument::TomlDocument(const std::string& path, const std::vector<std::string>& settings)
    : TomlDocument(path, read_text(path, largest_case_file), settings) {}

TomlDocument::TomlDocument(std::string name, const std::string& text,
                           const std::vector<std::string>& settings, std::shared_ptr<const CaseParts> parts)
    : path_(std::move(name)), parts_(std::move(parts)) {
  if (const long line = line_nested_too_deep(text); line > 0)
    throw InputError(
        fmt::format("{}:{}:1: not valid: a key has more than {} parts", path_, line, deepest_key));
  try {
    root_ = toml::parse(text);
  } catch (const toml::parse_error& error) {
    const toml::source_position at = error.source().begin;
    throw InputError(fmt::format("{}:{}:{}: not valid TOML: {}", path_, at.line, at.column,
                                 printable(error.description(), longest_name)));
  }
  for (const std::string& setting : settings) apply(setting);
}

void TomlDocument::apply(const std::string& setting) {
  const std::size_t equals = setting.find('=');
  const std::string path = setting.substr(0, equals);
  const std::vector<std::string> keys = split_path(path);
  if (equals == std::string::npos || keys.empty() || path.ends_with('.') || keys.size() > deepest_key ||
      !std::all_of(keys.begin(), keys.end(), is_bare_word)) {
    refuse(setting, "expected section.key=value");
  }
  toml::table* table = &root_;
  for (std::size_t i = 0; i + 1 < keys.size(); ++i) {
    table->insert(keys[i], toml::table{});  // unless it is there
    table = table->get_as<toml::table>(keys[i]);
    if (table == nullptr)
      refuse(setting, fmt::format("'{}' is not a table", printable(keys[i], longest_name)));
  }
  const toml::table value = parse_value(setting, setting.substr(equals + 1));
  table->insert_or_assign(keys.back(), *value.get("value"));  // a copy, without a place in a file
}

void TomlDocument::fail(const toml::node* node, const std::string& name, const std::string& what) const {
  const toml::source_position at = node != nullptr ? node->source().begin : toml::source_position{1, 1};
  const std::string key = printable(name, longest_name);
  if (!at) throw InputError(fmt::format("--set: {}: {}", key, what));
  throw InputError(fmt::format("{}:{}:{}: {}: {}", path_, at.line, at.column, key, what));
}

void TomlDocument::mismatch(const toml::node& node, const std::string& name, const std::string& expected,
                            const toml::node* place) const {
  fail(place != nullptr ? place : &node, name, fmt::format("expected {}, got {}", expected, shown(node)));
}

double TomlDocument::number(const Replacement& value, const NumberRule& rule) const {
  if (const std::optional<double> number = accepted(*value.node, rule)) return *number;
  const std::string expected = "a finite number" + rule.text;
  if (exact_number(*value.node) || !value.node->is_integer())
    mismatch(*value.node, value.name, expected, value.place);
  fail(value.place != nullptr ? value.place : value.node, value.name,
       fmt::format("expected {}, got {}, an integer that no double equals; {}.0 is rounded", expected,
                   shown(*value.node), shown(*value.node)));
}

NumberRule any_number() {
  return {[](double /*value*/) { return true; }, ""};
}

NumberRule positive() {
  return {[](double value) { return value > 0; }, " > 0"};
}

NumberRule inside(double low, double high) {
  return {[low, high](double value) { return value > low && value < high; },
          fmt::format(" > {} and < {}", low, high)};
}

NumberRule within(double low, double high, const std::string& text) {
  return {[low, high](double value) { return value >= low && value <= high; },
          text.empty() ? fmt::format(" >= {} and <= {}", low, high) : text};
}

NumberRule at_least(double low, double high) {
  return {[low, high](double value) { return value >= low && value <= high; }, fmt::format(" >= {}", low)};
}

NumberRule up_to(double high) {
  return {[high](double value) { return value > 0 && value <= high; }, fmt::format(" > 0 and <= {}", high)};
}

TomlSection::TomlSection(const TomlDocument& document, std::string path, const Replacements* replacements)
    : document_(document), path_(std::move(path)), replacements_(replacements) {
  const toml::node* node = &document.root();
  for (const std::string& part : split_path(path_)) {
    node = node->as_table()->get(part);
    if (node == nullptr) return;
    if (!node->is_table()) document.mismatch(*node, path_, "a table");
  }
  table_ = node->as_table();
}

std::string TomlSection::name(std::string_view key) const {
  return path_.empty() ? std::string(key) : fmt::format("{}.{}", path_, key);
}

/// Few are replaced, and names are put together only where they are told.
const Replacement* TomlSection::replaced(std::string_view key) const {
  if (replacements_ == nullptr) return nullptr;
  for (const auto& [name, replacement] : *replacements_) {
    if (name.size() == path_.size() + 1 + key.size() && name.ends_with(key) && name.starts_with(path_) &&
        name[path_.size()] == '.')
      return &replacement;
  }
  return nullptr;
}

const toml::node* TomlSection::node(std::string_view key) const {
  if (const Replacement* replacement = replaced(key)) return replacement->node;
  return table_ != nullptr ? table_->get(key) : nullptr;
}

Replacement TomlSection::find(std::string_view key) const {
  const Replacement* replacement = replaced(key);
  return replacement != nullptr ? *replacement : Replacement{node(key), name(key)};
}

const toml::node& TomlSection::require(std::string_view key, const std::string& expected) const {
  const toml::node* value = node(key);
  if (value == nullptr) fail(key, fmt::format("missing; expected {}", expected));
  return *value;
}

void TomlSection::fail(std::string_view key, const std::string& what) const {
  const Replacement value = find(key);
  const toml::node* node = value.node != nullptr ? value.node : table_;
  document_.fail(value.place != nullptr ? value.place : node, value.name, what);
}

void TomlSection::mismatch(std::string_view key, const std::string& expected) const {
  const Replacement value = find(key);
  document_.mismatch(*value.node, value.name, expected, value.place);
}

double TomlSection::number(std::string_view key, const NumberRule& rule) const {
  const toml::node* value = node(key);
  if (value == nullptr) fail(key, fmt::format("missing; expected a finite number{}", rule.text));
  const std::optional<double> number = accepted(*value, rule);
  return number ? *number : document_.number(find(key), rule);
}

Index TomlSection::integer(std::string_view key, const NumberRule& rule) const {
  const std::string expected = "an integer" + rule.text;
  const auto* value = require(key, expected).as_integer();
  if (value == nullptr || !rule.holds(static_cast<double>(value->get()))) mismatch(key, expected);
  return value->get();
}

std::string TomlSection::text(std::string_view key, const std::vector<std::string>& choices,
                              const std::string& remark) const {
  const std::string expected = choices.empty() ? "a string" : one_of(choices) + remark;
  const auto value = require(key, expected).value_exact<std::string>();
  if (!value || (!choices.empty() && std::find(choices.begin(), choices.end(), *value) == choices.end())) {
    mismatch(key, expected);
  }
  return *value;
}

std::vector<double> TomlSection::numbers(std::string_view key, const NumberRule& rule) const {
  std::vector<double> values;
  if (!has(key)) return values;
  const toml::array* array = require(key, "").as_array();
  if (array == nullptr) mismatch(key, "an array of numbers");
  for (std::size_t i = 0; i < array->size(); ++i) {
    values.push_back(document_.number({array->get(i), fmt::format("{}[{}]", name(key), i)}, rule));
  }
  return values;
}

std::pair<double, double> TomlSection::rising(std::string_view key, const std::string& expected) const {
  require(key, expected);
  const std::vector<double> pair = numbers(key, positive());
  if (pair.size() != 2 || !(pair[0] < pair[1])) mismatch(key, expected);
  return {pair[0], pair[1]};
}

bool TomlSection::boolean(std::string_view key) const {
  const auto value = require(key, "true or false").value_exact<bool>();
  if (!value) mismatch(key, "true or false");
  return *value;
}

std::vector<std::string> TomlSection::texts(std::string_view key, const std::vector<std::string>& choices,
                                            const std::string& expected) const {
  const toml::array* array = require(key, expected).as_array();
  if (array == nullptr) mismatch(key, expected);
  std::vector<std::string> values;
  for (const toml::node& node : *array) {
    const auto value = node.value_exact<std::string>();
    if (!value || (!choices.empty() && std::find(choices.begin(), choices.end(), *value) == choices.end()))
      document_.mismatch(node, fmt::format("{}[{}]", name(key), values.size()), expected);
    values.push_back(*value);
  }
  return values;
}

TomlSection TomlSection::inside(std::string_view key, const std::string& expected) const {
  const Replacement value = find(key);
  const toml::table* table = require(key, expected).as_table();
  if (table == nullptr) mismatch(key, expected);
  return {document_, *table, value.name, replacements_};
}

void TomlSection::allow_only(const std::vector<std::string>& keys) const {
  if (table_ == nullptr) return;
  for (const auto& [key, node] : *table_) {
    if (std::find(keys.begin(), keys.end(), key.str()) != keys.end()) continue;
    document_.fail(&node, name(key.str()), unknown_key(key.str(), keys));
  }
}

std::string one_of(const std::vector<std::string>& choices) {
  return fmt::format("\"{}\"", fmt::join(choices, "\" or \""));
}

std::string unknown_key(std::string_view key, const std::vector<std::string>& keys) {
  const std::string meant = nearest_name(key, keys);
  if (!meant.empty()) return fmt::format("unknown key; did you mean '{}'?", meant);
  return fmt::format("unknown key; expected one of {}", fmt::join(keys, ", "));
}

nlohmann::ordered_json to_json(const toml::node& node) {
  using nlohmann::ordered_json;
  if (const toml::table* table = node.as_table()) {
    ordered_json object = ordered_json::object();
    for (const auto& [key, value] : *table) object[std::string(key.str())] = to_json(value);
    return object;
  }
  if (const toml::array* array = node.as_array()) {
    ordered_json list = ordered_json::array();
    for (const toml::node& value : *array) list.push_back(to_json(value));
    return list;
  }
  if (const auto* value = node.as_integer()) return value->get();
  if (const auto* value = node.as_floating_point()) return value->get();
  if (const auto* value = node.as_boolean()) return value->get();
  if (const auto* value = node.as_string()) return value->get();
  return shown(node);
}

std::string nearest_name(std::string_view name, const std::vector<std::string>& names) {
  const auto distance = [](std::string_view a, std::string_view b) {  // Levenshtein
    std::vector<std::size_t> row(b.size() + 1);
    std::iota(row.begin(), row.end(), std::size_t{0});
    for (std::size_t i = 1; i <= a.size(); ++i) {
      std::size_t diagonal = row[0];
      row[0] = i;
      for (std::size_t k = 1; k <= b.size(); ++k) {
        const std::size_t changed = diagonal + static_cast<std::size_t>(a[i - 1] != b[k - 1]);
        diagonal = row[k];
        row[k] = std::min({row[k] + 1, row[k - 1] + 1, changed});
      }
    }
    return row.back();
  };
  std::string best;
  if (name.size() > longest_name) return best;
  std::size_t least = std::max<std::size_t>(2, name.size() / 3) + 1;
  for (const std::string& candidate : names) {
    if (const std::size_t d = distance(name, candidate); d < least) {
      least = d;
      best = candidate;
    }
  }
  return best;
}

}  // namespace arcslip
