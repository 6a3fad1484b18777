#include "results/result_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <system_error>

#include "arcslip/cases/case_file.hpp"

namespace arcslip {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

/// The fields of a line; one in double quotes may hold commas, and quotes twice.
std::vector<std::string> fields_of(const std::string& line) {
  std::vector<std::string> fields(1);
  bool quoted = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (line[i] == '"') {
      if (quoted && i + 1 < line.size() && line[i + 1] == '"') {
        fields.back() += line[i++];
      } else {
        quoted = !quoted;
      }
    } else if (line[i] == ',' && !quoted) {
      fields.emplace_back();
    } else if (line[i] != '\r') {
      fields.back() += line[i];
    }
  }
  return fields;
}

ordered_json value_of(const std::string& field) {
  char* end = nullptr;
  const double number = std::strtod(field.c_str(), &end);
  const bool is_number = !field.empty() && end == field.c_str() + field.size();
  return is_number ? ordered_json(number) : ordered_json(field);
}

}  // namespace

std::ifstream open_results(const fs::path& path) {
  std::error_code none;
  std::ifstream file;
  if (fs::is_regular_file(path, none)) file.open(path, std::ios::binary);
  if (!file.is_open()) {
    throw InputError(
        fmt::format("{}: cannot be read; expected a file that arcslip has written", path.string()));
  }
  return file;
}

ResultTable::ResultTable(fs::path path, const std::vector<std::string>& columns, const char* holds)
    : path_(std::move(path)) {
  std::ifstream file = open_results(path_);
  std::string line;
  std::getline(file, line);
  columns_ = fields_of(line);
  require(columns);
  if (!std::getline(file, line)) throw InputError(fmt::format("{}: holds no {}", path_.string(), holds));
}

bool ResultTable::has(const std::string& name) const {
  return std::find(columns_.begin(), columns_.end(), name) != columns_.end();
}

void ResultTable::require(const std::vector<std::string>& names) const {
  for (const std::string& name : names) {
    if (has(name)) continue;
    throw InputError(
        fmt::format("{}: has no column {}; expected a table that arcslip has written", path_.string(), name));
  }
}

void ResultTable::for_each_row(
    const std::function<void(const std::vector<std::string>& fields)>& visitor) const {
  std::ifstream file = open_results(path_);
  std::string line;
  std::getline(file, line);
  for (std::size_t number = 2; std::getline(file, line); ++number) {
    const std::vector<std::string> fields = fields_of(line);
    if (fields.size() != columns_.size())
      throw InputError(fmt::format("{}: line {} has {} fields; expected {}", path_.string(), number,
                                   fields.size(), columns_.size()));
    visitor(fields);
  }
}

std::size_t ResultTable::place(const std::string& name) const {
  require({name});
  return static_cast<std::size_t>(std::find(columns_.begin(), columns_.end(), name) - columns_.begin());
}

std::vector<std::vector<ordered_json>> ResultTable::read(const std::vector<std::string>& names) const {
  std::vector<std::size_t> places(names.size());
  std::transform(names.begin(), names.end(), places.begin(),
                 [&](const std::string& name) { return place(name); });
  std::vector<std::vector<ordered_json>> values(names.size());
  for_each_row([&](const std::vector<std::string>& fields) {
    for (std::size_t k = 0; k < places.size(); ++k) values[k].push_back(value_of(fields[places[k]]));
  });
  return values;
}

}  // namespace arcslip
