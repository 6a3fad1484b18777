// What the README and the manual show is what the project holds; tests/manual runs what can be run.

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

}  // namespace

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
  CHECK(tables == 16);
}

TEST_CASE("Every case file stands in the manual's table") {
  const std::string text = page("cases");
  for (const auto& entry : std::filesystem::directory_iterator(source + "/problems")) {
    if (entry.path().extension() != ".toml") continue;
    INFO(entry.path());
    CHECK_THAT(text, ContainsSubstring(fmt::format("`{}`", entry.path().stem().string())));
  }
}
