#include "cases/output_weights.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numeric>
#include <optional>

#include "cases/named_file.hpp"
#include "keys/printable.hpp"

namespace arcslip {
namespace {

constexpr std::string_view blanks = " \t\r";
constexpr std::string_view letters = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ";

std::string_view trimmed(std::string_view text) {
  text.remove_prefix(std::min(text.find_first_not_of(blanks), text.size()));
  return text.substr(0, text.find_last_not_of(blanks) + 1);
}

/// What stands between the commas of a line.
std::vector<std::string_view> cells(std::string_view line) {
  std::vector<std::string_view> all;
  for (std::size_t end = line.find(','); end != line.npos; end = line.find(',')) {
    all.push_back(trimmed(line.substr(0, end)));
    line.remove_prefix(end + 1);
  }
  all.push_back(trimmed(line));
  return all;
}

std::optional<double> as_number(std::string_view text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return {};
  return value;
}

/// Letters, digits and _, and no name of a harmonic, a greatest value or a contact.
bool is_allowed(const std::string& name) {
  const auto is_letter = [](char c) { return letters.find(c) != letters.npos; };
  const auto is_allowed_inside = [=](char c) { return is_letter(c) || (c >= '0' && c <= '9') || c == '_'; };
  if (name.empty() || !is_letter(name.front())) return false;
  if (!std::all_of(name.begin(), name.end(), is_allowed_inside)) return false;
  const std::size_t last = name.find_last_not_of("0123456789");
  const bool is_order = last != name.npos && name[last] == 'h' && last + 1 < name.size() &&
                        (last == 0 || name[last - 1] == '_');
  const bool is_peak = name == "peak" || (name.size() > 5 && name.substr(name.size() - 5) == "_peak");
  const bool is_column = name.rfind("contact_", 0) == 0 || name.rfind("nd_", 0) == 0 || name == "max" ||
                         name == "m" || name == "opt";
  return !is_order && !is_peak && !is_column;
}

WeightRow row_of(const std::string& line, const std::string& place, std::size_t number, Index size) {
  std::vector<std::string_view> all = cells(line);
  WeightRow row{fmt::format("w{}", number), std::vector<Index>(static_cast<std::size_t>(size)), {}};
  std::iota(row.dofs.begin(), row.dofs.end(), 0);
  if (!as_number(all.front())) {
    row.name = std::string(all.front());
    all.erase(all.begin());
  }
  if (std::ssize(all) != size)
    throw MatrixTextError(
        fmt::format("{}: expected {} weights, one for each dof, got {}", place, size, all.size()));
  for (Index i = 0; i < size; ++i) {
    const std::string_view given = all[static_cast<std::size_t>(i)];
    const std::optional<double> weight = as_number(given);
    if (!weight || !std::isfinite(*weight))
      throw MatrixTextError(
          fmt::format("{}: expected a finite number as weight of dof {}{}", place, i + 1,
                      weight ? fmt::format(", got {}", *weight) : ", got a word that is no number"));
    row.weights.push_back(*weight);
  }
  return row;
}

std::vector<WeightRow> rows_of(std::string_view text, const std::string& file, Index size) {
  std::vector<WeightRow> rows;
  for (std::size_t number = 1; !text.empty(); ++number) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    line = trimmed(line.substr(0, line.find('#')));
    if (line.empty()) continue;
    rows.push_back(row_of(std::string(line), fmt::format("{}:{}", file, number), rows.size() + 1, size));
  }
  if (rows.empty()) throw MatrixTextError(file + ": expected rows of weights, got none");
  return rows;
}

WeightRow row_of(const TomlSection& tables, std::string_view name, Index size) {
  const TomlSection table = tables.inside(name, "a table { dof = [...], value = [...] }");
  table.allow_only({"dof", "value"});
  table.require("dof", "an array of dofs");
  table.require("value", "an array of numbers");
  WeightRow row{std::string(name), listed_dofs(table, "dof", size), table.numbers("value", any_number())};
  if (row.dofs.empty()) table.fail("dof", "expected one dof or more, got none");
  if (row.weights.size() != row.dofs.size())
    table.fail("value", fmt::format("expected {} numbers, as many as dofs, got {}", row.dofs.size(),
                                    row.weights.size()));
  return row;
}

void check_names(const std::vector<WeightRow>& rows, const TomlSection& section) {
  for (auto row = rows.begin(); row != rows.end(); ++row) {
    if (!is_allowed(row->name))
      section.fail("weights", fmt::format("expected names of letters, digits and _, that begin with a letter "
                                          "and name no other column, got \"{}\"",
                                          printable(row->name, 40)));
    const auto is_same = [&](const WeightRow& other) { return other.name == row->name; };
    if (std::any_of(rows.begin(), row, is_same))
      section.fail("weights",
                   fmt::format("expected names that differ, got \"{}\" twice", printable(row->name, 40)));
  }
}

}  // namespace

std::vector<Index> listed_dofs(const TomlSection& section, std::string_view key, Index size) {
  const NumberRule rule{
      [=](double dof) { return dof >= 1 && dof <= static_cast<double>(size) && dof == std::floor(dof); },
      fmt::format(" that is a dof from 1 to {}", size)};
  std::vector<Index> dofs;
  for (const double dof : section.numbers(key, rule)) dofs.push_back(static_cast<Index>(dof) - 1);
  return dofs;
}

std::vector<WeightRow> read_weights(const TomlSection& section, Index size, std::uint64_t* fingerprint) {
  const char* expected = "a file of weights, or a table { NAME = { dof = [...], value = [...] } }";
  std::vector<WeightRow> rows;
  if (section.require("weights", expected).is_string()) {
    rows =
        parsed(section, "weights", largest_list, fingerprint,
               [&](const std::string& text, const std::string& path) { return rows_of(text, path, size); });
  } else {
    const TomlSection tables = section.inside("weights", expected);
    if (tables.table()->empty()) section.fail("weights", "expected one output or more, got none");
    for (const auto& [key, node] : *tables.table()) rows.push_back(row_of(tables, key.str(), size));
  }
  check_names(rows, section);
  return rows;
}

void add_combination(PartSettings& part, const WeightRow& row) {
  SectorOutput output{row.name, {}};
  std::vector<Index>& seen = part.sector.outputs;
  for (std::size_t i = 0; i < row.dofs.size(); ++i) {
    if (row.weights[i] == 0 && (i + 1 < row.dofs.size() || !output.terms.empty())) continue;
    const auto place = std::find(seen.begin(), seen.end(), row.dofs[i]);
    output.terms.push_back({place - seen.begin(), row.weights[i]});
    if (place != seen.end()) continue;
    seen.push_back(row.dofs[i]);
    ++part.untold;
  }
  part.combinations.push_back(std::move(output));
}

std::vector<Key<OutputSettings>> output_keys() {
  using OutputKey = Key<OutputSettings>;
  const auto read_dofs = [](OutputSettings& settings, const TomlSection& section) {
    for (const Index dof : listed_dofs(section, "output", settings.dofs))
      settings.outputs.push_back({fmt::format("{}", dof + 1), true, Vector::Unit(settings.dofs, dof)});
  };
  const auto read_rows = [](OutputSettings& settings, const TomlSection& section) {
    for (const WeightRow& row : read_weights(section, settings.dofs, nullptr)) {
      WantedOutput& output = settings.outputs.emplace_back(row.name, true, Vector::Zero(settings.dofs));
      for (std::size_t i = 0; i < row.dofs.size(); ++i) output.weights(row.dofs[i]) += row.weights[i];
    }
  };
  return {
      OutputKey::special("output", "list of dofs",
                         "whose amplitudes follow in `branches.csv`: `Y_2` of the base, `U_2` of the damper",
                         read_dofs, otherwise("none")),
      OutputKey::special("weights", "file or table",
                         "outputs that are sums of dofs times weights, as those of sectors", read_rows,
                         otherwise("none"))};
}

void want(std::vector<WantedOutput> outputs, bool on_base, SystemParameters& system) {
  for (WantedOutput& output : outputs) {
    output.on_base = on_base;
    system.wanted.push_back(std::move(output));
  }
}

}  // namespace arcslip
