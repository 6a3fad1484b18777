#include "toml_reader.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <numeric>
#include <sstream>
#include <system_error>

namespace arcslip {
namespace {

std::string one_line(std::string text) {
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text;
}

std::string shown(const toml::node& node) {
  if (node.is_table()) return "a table";
  if (const toml::array* array = node.as_array()) return array->empty() ? "an empty array" : "an array";
  if (const auto* value = node.as_string()) return fmt::format("\"{}\"", one_line(value->get()));
  if (const auto* value = node.as_floating_point()) return fmt::format("{}", value->get());
  std::ostringstream out;
  node.visit([&](const auto& value) { out << value; });
  return out.str();
}

std::vector<std::string> split_path(const std::string& path) {
  std::vector<std::string> parts;
  std::istringstream in(path);
  for (std::string part; std::getline(in, part, '.');) parts.push_back(part);
  return parts;
}

bool is_bare_word(const std::string& text) {
  return !text.empty() && std::all_of(text.begin(), text.end(), [](unsigned char c) {
    return std::isalnum(c) != 0 || c == '_' || c == '-';
  });
}

/// The value of a setting as TOML; a bare word may go without quotes.
toml::table parse_value(const std::string& setting, const std::string& value) {
  try {
    return toml::parse("value = " + value);
  } catch (const toml::parse_error&) {
    if (is_bare_word(value)) return toml::table{{"value", value}};
    throw InputError(fmt::format("--set {}: '{}' is not a TOML value", setting, value));
  }
}

}  // namespace

std::string read_text(const std::string& path) {
  errno = std::filesystem::is_directory(path) ? EISDIR : 0;
  std::ifstream in(path, std::ios::binary);
  std::ostringstream text;
  if (errno == 0 && in) text << in.rdbuf();
  if (errno != 0 || !in || in.bad()) {
    const int code = errno != 0 ? errno : EIO;
    throw InputError(fmt::format("{}: cannot be read: {}", path, std::generic_category().message(code)));
  }
  return text.str();
}

TomlDocument::TomlDocument(const std::string& path, const std::vector<std::string>& settings) : path_(path) {
  const std::string text = read_text(path);
  try {
    root_ = toml::parse(text);
  } catch (const toml::parse_error& error) {
    const toml::source_position at = error.source().begin;
    throw InputError(fmt::format("{}:{}:{}: not valid TOML: {}", path, at.line, at.column,
                                 one_line(std::string(error.description()))));
  }
  for (const std::string& setting : settings) apply(setting);
}

void TomlDocument::apply(const std::string& setting) {
  const std::size_t equals = setting.find('=');
  const std::vector<std::string> keys = split_path(setting.substr(0, equals));
  if (equals == std::string::npos || keys.empty() || !std::all_of(keys.begin(), keys.end(), is_bare_word)) {
    throw InputError(fmt::format("--set {}: expected section.key=value", setting));
  }
  toml::table* table = &root_;
  for (std::size_t i = 0; i + 1 < keys.size(); ++i) {
    table->insert(keys[i], toml::table{});  // unless it is there
    table = table->get_as<toml::table>(keys[i]);
    if (table == nullptr) throw InputError(fmt::format("--set {}: '{}' is not a table", setting, keys[i]));
  }
  const toml::table value = parse_value(setting, setting.substr(equals + 1));
  table->insert_or_assign(keys.back(), *value.get("value"));  // a copy, without a place in a file
}

void TomlDocument::fail(const toml::node* node, const std::string& name, const std::string& what) const {
  const toml::source_position at = node != nullptr ? node->source().begin : toml::source_position{1, 1};
  if (!at) throw InputError(fmt::format("--set: {}: {}", name, what));
  throw InputError(fmt::format("{}:{}:{}: {}: {}", path_, at.line, at.column, name, what));
}

void TomlDocument::mismatch(const toml::node& node, const std::string& name, const std::string& expected,
                            const toml::node* place) const {
  fail(place != nullptr ? place : &node, name, fmt::format("expected {}, got {}", expected, shown(node)));
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

NumberRule within(double low, double high) {
  return {[low, high](double value) { return value >= low && value <= high; },
          fmt::format(" >= {} and <= {}", low, high)};
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

Replacement TomlSection::find(std::string_view key) const {
  if (replacements_ != nullptr) {
    const auto found = replacements_->find(name(key));
    if (found != replacements_->end()) return found->second;
  }
  return {table_ != nullptr ? table_->get(key) : nullptr, name(key)};
}

const toml::node& TomlSection::require(std::string_view key, const std::string& expected) const {
  const Replacement value = find(key);
  if (value.node == nullptr) fail(key, fmt::format("missing; expected {}", expected));
  return *value.node;
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

double TomlSection::checked(const Replacement& value, const NumberRule& rule) const {
  const double number = value.node->is_number() ? *value.node->value<double>() : std::nan("");
  if (!std::isfinite(number) || !rule.holds(number))
    document_.mismatch(*value.node, value.name, "a finite number" + rule.text, value.place);
  return number;
}

double TomlSection::number(std::string_view key, const NumberRule& rule) const {
  require(key, "a finite number" + rule.text);
  return checked(find(key), rule);
}

double TomlSection::number(std::string_view key, const NumberRule& rule, double otherwise) const {
  return has(key) ? number(key, rule) : otherwise;
}

Index TomlSection::integer(std::string_view key, Index low, Index high, const std::string& expected) const {
  const toml::node& node = require(key, expected);
  const auto value = node.value_exact<std::int64_t>();
  if (!value || *value < low || *value > high) mismatch(key, expected);
  return *value;
}

Index TomlSection::integer(std::string_view key, Index low, Index high, const std::string& expected,
                           Index otherwise) const {
  return has(key) ? integer(key, low, high, expected) : otherwise;
}

std::string TomlSection::text(std::string_view key, const std::vector<std::string>& choices) const {
  const std::string expected =
      choices.empty() ? "a string" : fmt::format("\"{}\"", fmt::join(choices, "\" or \""));
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
    values.push_back(checked({array->get(i), fmt::format("{}[{}]", name(key), i)}, rule));
  }
  return values;
}

bool TomlSection::boolean(std::string_view key, bool otherwise) const {
  if (!has(key)) return otherwise;
  const auto value = require(key, "").value_exact<bool>();
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

void TomlSection::allow_only(const std::vector<std::string>& keys) const {
  if (table_ == nullptr) return;
  for (const auto& [key, node] : *table_) {
    if (std::find(keys.begin(), keys.end(), key.str()) != keys.end()) continue;
    document_.fail(&node, name(key.str()), unknown_key(key.str(), keys));
  }
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
