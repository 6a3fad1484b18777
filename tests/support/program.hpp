#pragma once

// The program run as a user runs it.

#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "places.hpp"
#include "temporary_folder.hpp"

namespace arcslip::testing {

inline const std::string program = program_path();

inline std::string case_named(const std::string& name) {
  return source_folder() + "/problems/" + name + ".toml";
}

inline const std::string figure_8_case = case_named("figure_8");

/// What `run` leaves in a folder.
inline const std::set<std::string> run_results = {"branches.csv", "curves.csv", "summary.json"};

struct Outcome {
  int status;
  std::string out;
  std::string err;
};

inline Outcome shell(const std::string& command) {
  const TemporaryFolder folder;
  const std::string whole =
      "{ " + command + "; } >'" + folder.path("out") + "' 2>'" + folder.path("err") + "'";
  const int code = std::system(whole.c_str());
  return {WIFEXITED(code) ? WEXITSTATUS(code) : -1, read(folder.path("out")), read(folder.path("err"))};
}

inline Outcome arcslip_program(const std::string& arguments) {
  return shell("'" + program + "' " + arguments);
}

inline bool is_one_line(const std::string& text) {
  return !text.empty() && text.find('\n') == text.size() - 1;
}

inline std::vector<std::vector<std::string>> read_csv(const std::string& path) {
  std::vector<std::vector<std::string>> rows;
  std::istringstream in(read(path));
  for (std::string line; std::getline(in, line);) {
    rows.emplace_back();
    std::istringstream cells(line);
    for (std::string cell; std::getline(cells, cell, ',');) rows.back().push_back(cell);
  }
  return rows;
}

inline std::set<std::string> names_in(const std::string& folder) {
  std::set<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) names.insert(entry.path().filename());
  return names;
}

}  // namespace arcslip::testing
