#include "cases/for_each.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "keys/printable.hpp"

namespace arcslip {
namespace {

using nlohmann::ordered_json;

constexpr std::size_t most_sets = 1'000'000'000;
constexpr std::size_t most_samples = 10'000;  // of sets that are combined, a fraction of a second
constexpr std::size_t most_together =
    1'000'000;  // of those that are not, which no longer lists make, seconds

/// A key, dotted if it stands in a table of its own, with its value.
struct Entry {
  std::string key;
  const toml::key* last;  ///< part of it
  const toml::node* node;
};

void collect(const toml::table& table, const std::string& prefix, const std::vector<std::string>& allowed,
             std::vector<Entry>& entries) {
  for (const auto& [key, node] : table) {
    const std::string name = prefix + std::string(key.str());
    const bool is_group = std::any_of(allowed.begin(), allowed.end(),
                                      [&](const std::string& one) { return one.starts_with(name + "."); });
    if (is_group && node.is_table()) {
      collect(*node.as_table(), name + ".", allowed, entries);
    } else {
      entries.push_back({name, &key, &node});
    }
  }
}

/// The entries of a table in the order of the file, which the table does not keep. Refuses other keys.
std::vector<Entry> entries_of(const TomlDocument& document, const toml::table& table, const std::string& path,
                              const std::vector<std::string>& allowed) {
  std::vector<Entry> entries;
  collect(table, "", allowed, entries);
  std::stable_sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) {
    return a.last->source().begin < b.last->source().begin;
  });
  for (const Entry& entry : entries) {
    if (std::find(allowed.begin(), allowed.end(), entry.key) == allowed.end())
      document.fail(entry.node, path + "." + entry.key, unknown_key(entry.key, allowed));
  }
  return entries;
}

std::string keys_of(const std::vector<Entry>& entries) {
  std::vector<std::string> keys;
  keys.reserve(entries.size());
  for (const Entry& entry : entries) keys.push_back(entry.key);
  return printable(fmt::format("{}", fmt::join(keys, ", ")), longest_name);
}

}  // namespace

ForEach::ForEach(const TomlDocument& document, const TomlSection& section,
                 const std::vector<ListedKey>& listed, Lists lists)
    : document_(&document), path_(section.name("for_each")) {
  if (!section.has("for_each")) return;
  std::vector<std::string> allowed;
  for (const ListedKey& key : listed) allowed.push_back(key.name);
  const toml::array* tables = section.require("for_each", "").as_array();
  tables_ = tables != nullptr;
  if (tables_) {
    read_tables(section, *tables, allowed);
  } else {
    read_lists(section, allowed, lists);
  }
  for (Axis& axis : axes_) {
    for (std::size_t i = 1; i < axis.listed.size(); ++i) {
      if (axis.number(i) > axis.number(axis.largest)) axis.largest = i;
    }
    if (axis.range && axis.range->to > axis.range->from) axis.largest = axis.count - 1;
    keys_.push_back(axis.key);
    axis.path = std::find_if(listed.begin(), listed.end(), [&](const ListedKey& key) {
                  return key.name == axis.key;
                })->path;
  }
}

void ForEach::read_tables(const TomlSection& section, const toml::array& tables,
                          const std::vector<std::string>& allowed) {
  const char* expected = "a table of lists, or an array of tables that all have the same keys";
  if (tables.empty()) section.mismatch("for_each", expected);
  std::vector<Entry> first;
  for (std::size_t i = 0; i < tables.size(); ++i) {
    const std::string here = fmt::format("{}[{}]", path_, i);
    const toml::table* table = tables.get(i)->as_table();
    if (table == nullptr || table->empty())
      document_->mismatch(*tables.get(i), here, "a table with at least one key");
    const std::vector<Entry> entries = entries_of(*document_, *table, here, allowed);
    if (i == 0) {
      first = entries;
      for (const Entry& entry : entries) axes_.push_back({.key = entry.key, .place = &tables});
    }
    for (Axis& axis : axes_) {
      const auto found = std::find_if(entries.begin(), entries.end(),
                                      [&](const Entry& entry) { return entry.key == axis.key; });
      if (found == entries.end() || entries.size() != axes_.size()) {
        document_->fail(table, here,
                        fmt::format("expected the keys of the first table, {}; got {}", keys_of(first),
                                    keys_of(entries)));
      }
      axis.listed.push_back(found->node);
      axis.count = axis.listed.size();
    }
  }
  count_ = tables.size();
}

void ForEach::read_lists(const TomlSection& section, const std::vector<std::string>& allowed, Lists lists) {
  const TomlSection table(*document_, path_);
  const std::vector<Entry> entries = entries_of(*document_, *table.table(), path_, allowed);
  if (entries.empty()) section.mismatch("for_each", "a table with at least one key");
  combined_ = lists == Lists::combined;
  for (const auto& [key, last, node] : entries) {
    axes_.push_back(read_axis(key, *node));
    const std::size_t count = axes_.back().count;
    if (!combined_ && axes_.size() > 1 && count != count_) {
      document_->fail(
          node, table.name(key),
          fmt::format("expected {} values, as many as {} has (the lists are walked together), got {}", count_,
                      axes_.front().key, count));
    }
    if (combined_ && count > most_sets / count_)
      document_->fail(node, table.name(key),
                      fmt::format("with its {} values there are more than {:g} designs", count, 1e9));
    count_ = combined_ ? count_ * count : count;
  }
}

ForEach::Axis ForEach::read_axis(const std::string& key, const toml::node& node) const {
  const std::string name = path_ + "." + key;
  Axis axis{.key = key, .place = &node};
  if (const toml::table* range = node.as_table()) {
    axis.range = read_range(TomlSection(*document_, *range, name), axis.count);
    return axis;
  }
  const toml::array* list = node.as_array();
  if (list == nullptr || list->empty())
    document_->mismatch(node, name, "an array with at least one value, or a range { from, to, count }");
  axis.listed.reserve(list->size());
  for (const toml::node& value : *list) axis.listed.push_back(&value);
  axis.count = list->size();
  return axis;
}

ForEach::Range ForEach::read_range(const TomlSection& section, std::size_t& count) const {
  section.allow_only({"from", "to", "count", "scale"});
  Range range;
  range.logarithmic = section.has("scale") && section.text("scale", {"linear", "log"}) == "log";
  const NumberRule rule = range.logarithmic ? positive() : any_number();
  range.from = section.number("from", rule);
  range.to = section.number("to", rule);
  if (range.from == range.to) section.mismatch("to", "a number that differs from " + section.name("from"));
  count = static_cast<std::size_t>(section.integer("count", within(2, 1e9, " >= 2 and <= 1e9")));
  range.integers = !range.logarithmic && section.require("from", "").is_integer() &&
                   section.require("to", "").is_integer();
  return range;
}

double ForEach::Axis::number(std::size_t index) const {
  if (!range) return exact_number(*listed[index]).value_or(0);
  if (index == 0) return range->from;
  if (index == count - 1) return range->to;
  const auto steps = static_cast<double>(index);
  const auto whole = static_cast<double>(count - 1);
  const double part = steps / whole;
  if (range->logarithmic) {
    const double ratio = range->to / range->from;
    if (std::isnormal(ratio)) return range->from * std::pow(ratio, part);
    return std::pow(range->from, 1 - part) * std::pow(range->to, part);
  }
  const double span = range->to - range->from;
  if (std::isfinite(whole * span)) return range->from + steps * span / whole;
  return range->from * (1 - part) + range->to * part;
}

std::unique_ptr<const toml::node> ForEach::Axis::make(std::size_t index) const {
  const double value = number(index);
  if (range->integers && value == std::floor(value))
    return std::make_unique<toml::value<std::int64_t>>(static_cast<std::int64_t>(value));
  return std::make_unique<toml::value<double>>(value);
}

bool ForEach::sets(const std::string& key) const {
  return std::find(keys_.begin(), keys_.end(), key) != keys_.end();
}

std::string ForEach::name(const Axis& axis, std::size_t index) const {
  return tables_ ? fmt::format("{}[{}].{}", path_, index, axis.key)
                 : fmt::format("{}.{}[{}]", path_, axis.key, index);
}

ForEachSet ForEach::at(std::size_t index) const {
  ForEachSet set;
  std::vector<std::size_t> position(axes_.size(), index);
  for (std::size_t k = axes_.size(); combined_ && k-- > 0; index /= axes_[k].count)
    position[k] = index % axes_[k].count;
  set.values = ordered_json::object();
  for (std::size_t k = 0; k < axes_.size(); ++k) {
    const Axis& axis = axes_[k];
    if (axis.range) set.made.push_back(axis.make(position[k]));
    const toml::node* node = axis.range ? set.made.back().get() : axis.listed[position[k]];
    set.values[axis.key] = arcslip::to_json(*node);
    set.replacements[axis.path] = {node, name(axis, position[k]), axis.range ? axis.place : node};
  }
  return set;
}

std::vector<std::size_t> ForEach::samples() const {
  std::vector<std::size_t> indices;
  if (!combined_ || count_ <= most_samples) {
    const std::size_t stride = (count_ + most_together - 1) / most_together;
    for (std::size_t i = 0; i < count_; i += stride) indices.push_back(i);
    if (stride > 1) indices.insert(indices.end(), {1, count_ - 1});
    return indices;
  }
  std::size_t base = 0;
  for (const Axis& axis : axes_) base = base * axis.count + axis.largest;
  std::size_t stride = count_;
  for (const Axis& axis : axes_) {
    stride /= axis.count;
    for (std::size_t i = 0; i < axis.count; ++i) {
      if (axis.range && i == 2) i = axis.count - 1;
      indices.push_back(base + i * stride - axis.largest * stride);
    }
  }
  return indices;
}

ForEachSet ForEach::lacking() const {
  ForEachSet first = at(0);
  std::erase_if(first.replacements, [&](const auto& replacement) {
    return static_cast<bool>(document_->root().at_path(replacement.first));
  });
  return first;
}

ordered_json ForEach::to_json() const {
  ordered_json written = tables_ ? ordered_json::array() : ordered_json::object();
  if (tables_) {
    for (std::size_t i = 0; i < count_; ++i) written.push_back(at(i).values);
  } else {
    for (const Axis& axis : axes_) written[axis.key] = arcslip::to_json(*axis.place);
  }
  return written;
}

}  // namespace arcslip
