#include "cases/output_weights.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>

#include "arcslip/sectors/matrix_market.hpp"
#include "keys/printable.hpp"

namespace arcslip {
namespace {

constexpr std::string_view blanks = " \t\r";
constexpr const char* letters = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ";

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
  if (name.empty() || std::string_view(letters).find(name.front()) == std::string_view::npos) return false;
  if (name.find_first_not_of(std::string(letters) + "0123456789_") != name.npos) return false;
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
  WeightRow row{fmt::format("w{}", number), Vector(size)};
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
    row.weights(i) = *weight;
  }
  return row;
}

}  // namespace

std::vector<WeightRow> read_weights(std::string_view text, const std::string& file, Index size) {
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

void add_combination(PartSettings& part, const std::string& name, const std::vector<Index>& dofs,
                     const std::vector<double>& weights, const TomlSection& section) {
  if (!is_allowed(name))
    section.fail("weights", fmt::format("expected names of letters, digits and _, that begin with a letter "
                                        "and name no other column, got \"{}\"",
                                        printable(name, 40)));
  const auto is_same = [&](const SectorOutput& other) { return other.name == name; };
  if (std::any_of(part.combinations.begin(), part.combinations.end(), is_same))
    section.fail("weights", fmt::format("expected names that differ, got \"{}\" twice", printable(name, 40)));
  SectorOutput output{name, {}};
  std::vector<Index>& seen = part.sector.outputs;
  for (std::size_t i = 0; i < dofs.size(); ++i) {
    if (weights[i] == 0 && (i + 1 < dofs.size() || !output.terms.empty())) continue;
    const auto place = std::find(seen.begin(), seen.end(), dofs[i]);
    output.terms.push_back({place - seen.begin(), weights[i]});
    if (place != seen.end()) continue;
    seen.push_back(dofs[i]);
    ++part.untold;
  }
  part.combinations.push_back(std::move(output));
}

}  // namespace arcslip
