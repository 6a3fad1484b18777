#pragma once

// The tables of results: their columns, and of small ones their rows.

#include <filesystem>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace arcslip {

/// Opens a file of results. Throws InputError.
std::ifstream open_results(const std::filesystem::path& path);

/// A CSV file that arcslip has written, of which only the first line is read at first, and whether there is a
/// second.
class ResultTable {
 public:
  /// `holds` is what a table without rows lacks. Throws InputError.
  ResultTable(std::filesystem::path path, const std::vector<std::string>& columns, const char* holds);

  const std::vector<std::string>& columns() const { return columns_; }
  bool has(const std::string& name) const;
  /// Throws InputError where a column is missing.
  void require(const std::vector<std::string>& names) const;

  /// Where a column stands, counted from 0. Throws InputError where it is missing.
  std::size_t place(const std::string& name) const;

  /// All rows in their order, each with as many fields as there are columns. Throws InputError.
  void for_each_row(const std::function<void(const std::vector<std::string>& fields)>& visitor) const;

  /// The values of some columns, one after the other: numbers, or texts where they are none. Throws
  /// InputError.
  std::vector<std::vector<nlohmann::ordered_json>> read(const std::vector<std::string>& names) const;

 private:
  std::filesystem::path path_;
  std::vector<std::string> columns_;
};

}  // namespace arcslip
