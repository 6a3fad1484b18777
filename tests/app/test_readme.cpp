// What the README and the manual show is what the project holds.

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <optional>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "arcslip/cases/case_file.hpp"
#include "catch.hpp"
#include "places.hpp"
#include "program.hpp"
#include "sector_files.hpp"

namespace testing = arcslip::testing;
using arcslip::testing::bladed_disk;
using arcslip::testing::lumped_ring;
using arcslip::testing::read;
using arcslip::testing::write_sector;

namespace {

const std::string source = arcslip::testing::source_folder();

std::string page(const std::string& name) {
  return read(fmt::format("{}/src/manual/pages/{}.md", source, name));
}

/// The README and all pages of the manual.
std::string manual() {
  std::string text = read(source + "/README.md");
  for (const auto& entry : std::filesystem::directory_iterator(source + "/src/manual/pages"))
    if (entry.path().extension() == ".md") text += "\n" + read(entry.path().string());
  return text;
}

/// Each line without what it is indented by.
std::string flush_left(const std::string& text) {
  std::string result;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) {
    const std::size_t first = line.find_first_not_of(' ');
    result += (first == std::string::npos ? "" : line.substr(first)) + "\n";
  }
  return result;
}

/// The blocks between ```language and ```.
std::vector<std::string> blocks(const std::string& text, const std::string& language) {
  const std::string opening = "```" + language + "\n";
  std::vector<std::string> found;
  for (std::size_t at = text.find(opening); at != std::string::npos; at = text.find(opening, at)) {
    at += opening.size();
    found.push_back(text.substr(at, text.find("```", at) - at));
  }
  return found;
}

/// Blocks that are indented by four blanks, line by line without them.
std::vector<std::vector<std::string>> indented_lines(const std::string& text) {
  std::vector<std::vector<std::string>> found;
  bool inside = false;
  bool fenced = false;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) {
    if (line.rfind("```", 0) == 0) fenced = !fenced;
    const bool belongs = !fenced && line.rfind("    ", 0) == 0;
    if (belongs && !inside) found.emplace_back();
    inside = belongs;
    if (inside) found.back().push_back(line.substr(4));
  }
  return found;
}

/// A command with what follows it.
struct Sample {
  std::string command;
  std::vector<std::string> output;
};

std::vector<Sample> samples(const std::string& text) {
  std::vector<Sample> found;
  for (const auto& block : indented_lines(text)) {
    bool shown = false;
    for (const std::string& line : block) {
      const bool is_command = line.rfind("$ ", 0) == 0;
      shown = shown || is_command;
      if (is_command) {
        found.push_back({line.substr(2), {}});
      } else if (shown) {
        found.back().output.push_back(line);
      }
    }
  }
  return found;
}

/// Without what differs from run to run.
std::string timeless(const std::string& line) {
  static const std::regex seconds(R"([0-9.e+-]+ s\b)");
  return std::regex_replace(line, seconds, "T s");
}

/// The first line of `expected` that `printed` has not at its place, where "..." stands for any lines; none
/// if there is none.
std::optional<std::string> missing(const std::vector<std::string>& expected, const std::string& printed) {
  std::vector<std::string> lines;
  std::istringstream in(printed);
  for (std::string line; std::getline(in, line);) lines.push_back(timeless(line));
  auto at = lines.begin();
  bool anywhere = false;
  for (const std::string& line : expected) {
    if (line == "...") {
      anywhere = true;
      continue;
    }
    const auto end = anywhere || at == lines.end() ? lines.end() : at + 1;
    const auto found = std::find(at, end, timeless(line));
    if (found == end) return line;
    at = found + 1;
    anywhere = false;
  }
  if (!anywhere && at != lines.end()) return "... (the end is not shown)";
  return std::nullopt;
}

/// A folder in which the manual's commands find what they name.
class Checkout {
 public:
  Checkout() { std::filesystem::create_symlink(source + "/problems", folder_.path("problems")); }

  testing::Outcome run(const std::string& command) const {
    return testing::shell(fmt::format("cd '{}' && arcslip() {{ '{}' \"$@\"; }} && {}", folder_.path("."),
                                      testing::program, command));
  }

 private:
  testing::TemporaryFolder folder_;
};

std::vector<std::string> words(const std::string& line) {
  std::istringstream in(line.substr(0, line.find(" #")));
  return {std::istream_iterator<std::string>(in), {}};
}

}  // namespace

TEST_CASE("Every output that the manual shows is what the program prints") {
  const Checkout checkout;
  int shown = 0;
  for (const Sample& sample : samples(manual())) {
    if (sample.output.empty()) continue;
    ++shown;
    INFO(sample.command);
    const testing::Outcome outcome = checkout.run(sample.command);
    CHECK(outcome.status == 0);
    const auto line = missing(sample.output, outcome.out);
    INFO(line.value_or(""));
    CHECK_FALSE(line.has_value());
  }
  CHECK(shown >= 2);
}

TEST_CASE(
    "Every command that the manual shows is one of the program's, with its options, of files that exist") {
  const std::set<std::string> made{"rotor/case.toml", "rotor", "study", "out/figure_8", "out/chart", "DIR"};
  const Checkout checkout;
  int commands = 0;
  for (const auto& block : indented_lines(manual())) {
    for (std::string line : block) {
      if (line.rfind("$ ", 0) == 0) line = line.substr(2);
      const std::vector<std::string> parts = words(line);
      if (parts.size() < 2 || (parts[0] != "arcslip" && parts[0] != "./dev")) continue;
      INFO(line);
      ++commands;
      const bool is_program = parts[0] == "arcslip";
      const testing::Outcome help =
          checkout.run(is_program ? fmt::format("arcslip {} --help", parts[1]) : "'" + source + "/dev' help");
      CHECK(help.status == 0);
      if (!is_program) CHECK_THAT(help.out, ContainsSubstring("  " + parts[1] + " "));
      for (std::size_t i = 2; i < parts.size(); ++i) {
        INFO(parts[i]);
        if (parts[i][0] == '-') {
          CHECK_THAT(help.out, ContainsSubstring(parts[i]));
        } else if (parts[i].find_first_of("/.") != std::string::npos) {
          CHECK((made.count(parts[i]) == 1 || checkout.run("cat " + parts[i]).status == 0));
        }
      }
    }
  }
  CHECK(commands >= 10);
}

TEST_CASE("A sample that lacks a line, or has another one, is told") {
  const std::string printed = "one\ntwo (3 boxes, 0.5 s)\nthree\n";
  CHECK_FALSE(missing({"one", "two (3 boxes, 0.02 s)", "three"}, printed));
  CHECK_FALSE(missing({"...", "three"}, printed));
  CHECK_FALSE(missing({"one", "..."}, printed));
  CHECK(missing({"two (3 boxes, 0.5 s)", "..."}, printed) == "two (3 boxes, 0.5 s)");
  CHECK(missing({"one", "two (4 boxes, 0.5 s)", "..."}, printed) == "two (4 boxes, 0.5 s)");
  CHECK(missing({"one", "three"}, printed) == "three");
  CHECK(missing({"one"}, printed) == "... (the end is not shown)");
  CHECK(missing({"...", "three", "four"}, printed) == "four");
}

TEST_CASE("The manual's C++ is that of the project which the tests build against the installed package") {
  const std::string text = manual();
  std::vector<std::string> files;
  for (const std::string name : {"own_problem", "friction", "further"})
    files.push_back(read(fmt::format("{}/tests/consumer/{}.cpp", source, name)));
  CHECK_THAT(text, ContainsSubstring("```cpp\n" + files[0] + "```"));  // this one as a whole
  const auto shown = blocks(text, "cpp");
  CHECK(shown.size() >= 6);
  for (const std::string& block : shown) {
    INFO(block);
    int times = 0;
    for (const std::string& file : files)
      times += static_cast<int>(flush_left(file).find(flush_left(block)) != std::string::npos);
    CHECK(times == 1);
  }
}

TEST_CASE("The manual's cases are problems/figure_8.toml, a sector and parts of others") {
  const arcslip::testing::TemporaryFolder folder;
  const arcslip::Case figure_8 = arcslip::read_case(source + "/problems/figure_8.toml");
  for (const std::string& text : {read(source + "/README.md"), page("start")}) {
    const auto shown = blocks(text, "toml");
    REQUIRE(shown.size() == 1);
    CHECK(arcslip::read_case(folder.write("case.toml", shown[0])).resolved == figure_8.resolved);
  }
  write_sector(folder, "rotor", bladed_disk(), "");
  write_sector(folder, "ring", lumped_ring(), "");
  const std::string range = "[branch]\nparameter = \"eta\"\nfrom = 100.0\nto = 200.0\n";
  CHECK_NOTHROW(
      arcslip::read_case(folder.write("sector.toml", blocks(page("sectors"), "toml").at(0) + range)));
  CHECK_THAT(read(source + "/problems/cubic_fold_curve.toml"),
             ContainsSubstring(blocks(page("keys"), "toml").at(0)));
  const auto studies = blocks(page("studies"), "toml");
  CHECK_THAT(read(source + "/problems/chart.toml"), ContainsSubstring(studies.at(0)));
  CHECK_THAT(read(source + "/problems/rotor_ring.toml"), ContainsSubstring(studies.at(1)));
}

TEST_CASE("The manual's tables of keys are those that the program prints") {
  const std::string text = manual();
  const testing::Outcome outcome = Checkout().run("arcslip help --markdown");
  CHECK(outcome.status == 0);
  int tables = 0;
  for (std::size_t at = 0; at < outcome.out.size(); ++tables) {
    const std::size_t end = outcome.out.find("\n\n", at) + 1;
    const std::string table = outcome.out.substr(at, end - at);
    INFO(table);
    CHECK(text.find("\n" + table) != std::string::npos);
    at = end + 1;
  }
  CHECK(tables == 12);
}

TEST_CASE("Every case file stands in the manual's table") {
  const std::string text = page("cases");
  for (const auto& entry : std::filesystem::directory_iterator(source + "/problems")) {
    if (entry.path().extension() != ".toml") continue;
    INFO(entry.path());
    CHECK_THAT(text, ContainsSubstring(fmt::format("`{}`", entry.path().stem().string())));
  }
}
