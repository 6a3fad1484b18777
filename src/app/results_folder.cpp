#include "app/results_folder.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <system_error>

#include "arcslip/cases/case_file.hpp"
#include "arcslip/version.hpp"
#include "results/result_table.hpp"

namespace arcslip {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

std::string drawn_table(const std::string& folder) {
  const auto path = [&](const char* name) { return fs::path(folder) / name; };
  const auto header = [&](const char* name) {
    std::ifstream file(path(name));
    std::string line;
    std::getline(file, line);
    return line;
  };
  std::error_code none;
  const bool newer =
      fs::last_write_time(path("branches.csv"), none) > fs::last_write_time(path("curves.csv"), none);
  return !newer && header("curves.csv") == header("branches.csv") ? "curves.csv" : "branches.csv";
}

ordered_json summary_of(const std::string& folder) {
  std::error_code none;
  if (!fs::is_directory(folder, none)) {
    throw InputError(
        fmt::format("{}: is not a folder; expected one that arcslip run or study has written", folder));
  }
  const std::string path = (fs::path(folder) / "summary.json").string();
  std::ifstream file = open_results(path);
  try {
    return ordered_json::parse(file);
  } catch (const ordered_json::parse_error& error) {
    throw InputError(fmt::format("{}: is not JSON (byte {})", path, error.byte));
  }
}

std::string reading(const std::string& folder, const ordered_json& summary,
                    const std::function<std::string()>& use) {
  const std::string version =
      summary.is_object() && summary.contains("arcslip") ? summary.at("arcslip").dump() : "";
  const std::string other =
      version.empty() || version == fmt::format("\"{}\"", release)
          ? ""
          : fmt::format(" (the results are of arcslip {}, this is \"{}\"; run the case again)", version,
                        release);
  const auto refuse = [&] {
    return InputError(fmt::format("{}: is not a summary that arcslip has written{}",
                                  (fs::path(folder) / "summary.json").string(), other));
  };
  try {
    return use();
  } catch (const InputError& error) {
    throw InputError(error.what() + other);
  } catch (const ordered_json::exception&) {
    throw refuse();
  } catch (const std::out_of_range&) {
    throw refuse();
  }
}

}  // namespace arcslip
