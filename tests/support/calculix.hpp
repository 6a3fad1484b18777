#pragma once

// The examples of problems/export, in a folder where commands are run, and what ccx prints there.

#include <fmt/format.h>

#include <filesystem>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "arcslip/types.hpp"
#include "program.hpp"

namespace arcslip::testing {

inline const std::string export_folder = source_folder() + "/problems/export";

/// The indented blocks of a text, each without its indent.
inline std::vector<std::string> indented(const std::string& text) {
  std::vector<std::string> blocks;
  bool inside = false;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) {
    const bool belongs = line.rfind("    ", 0) == 0;
    if (belongs && !inside) blocks.emplace_back();
    inside = belongs;
    if (inside) blocks.back() += line.substr(4) + "\n";
  }
  return blocks;
}

/// The examples, copied into a folder in which commands are run.
class Workshop {
 public:
  Workshop() {
    for (const auto& entry : std::filesystem::directory_iterator(export_folder)) {
      if (entry.path().extension() != ".md")
        folder_.write(entry.path().filename().string(), read(entry.path().string()));
    }
  }

  /// With one thread: with several, OpenBLAS' versions make ccx find other frequencies from one run to the
  /// next.
  Outcome run(const std::string& commands) const {
    return shell(
        fmt::format("export OPENBLAS_NUM_THREADS=1 && cd '{}' && arcslip() {{ '{}' \"$@\"; }} && {{ {}\n}}",
                    folder_.path("."), program, chained(commands)));
  }

  void write(const std::string& name, const std::string& text) const { folder_.write(name, text); }
  std::string path(const std::string& name) const { return folder_.path(name); }

 private:
  /// One command after the other, for as long as they succeed.
  static std::string chained(const std::string& commands) {
    std::string text;
    for (std::size_t i = 0; i + 1 < commands.size(); ++i) {
      const bool ends = commands[i] == '\n' && commands[i - 1] != '\\';
      text += ends ? " &&\n" : std::string(1, commands[i]);
    }
    return text;
  }

  TemporaryFolder folder_;
};

/// What ccx prints in JOB.dat, by the wave number; every frequency comes twice.
inline std::map<Index, std::vector<double>> printed_frequencies(const std::string& path) {
  std::map<Index, std::vector<double>> found;
  std::istringstream in(read(path));
  for (std::string line; std::getline(in, line);) {
    std::istringstream numbers(line);
    Index n = 0;
    int mode = 0;
    double square = 0, radians = 0, frequency = 0, imaginary = 0;
    if (numbers >> n >> mode >> square >> radians >> frequency >> imaginary && mode % 2 == 1)
      found[n].push_back(frequency);
  }
  return found;
}

}  // namespace arcslip::testing
