// What the README shows is what the project holds.

#include <fmt/format.h>

#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

#include "arcslip/case_file.hpp"
#include "catch.hpp"
#include "places.hpp"
#include "sector_files.hpp"

using arcslip::testing::bladed_disk;
using arcslip::testing::lumped_ring;
using arcslip::testing::read;
using arcslip::testing::write_sector;

namespace {

const std::string source = arcslip::testing::source_folder();

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

}  // namespace

TEST_CASE("The README's C++ is that of the project which the tests build against the installed package") {
  const std::string readme = read(source + "/README.md");
  std::vector<std::string> files;
  for (const std::string name : {"own_problem", "friction", "further"})
    files.push_back(read(fmt::format("{}/tests/consumer/{}.cpp", source, name)));
  CHECK_THAT(readme, ContainsSubstring("```cpp\n" + files[0] + "```"));  // this one as a whole
  const auto shown = blocks(readme, "cpp");
  CHECK(shown.size() >= 6);
  for (const std::string& block : shown) {
    INFO(block);
    int times = 0;
    for (const std::string& file : files)
      times += static_cast<int>(flush_left(file).find(flush_left(block)) != std::string::npos);
    CHECK(times == 1);
  }
}

TEST_CASE("The README's cases are problems/figure_8.toml, a sector and parts of others") {
  const auto shown = blocks(read(source + "/README.md"), "toml");
  REQUIRE(shown.size() == 5);
  const arcslip::testing::TemporaryFolder folder;
  const arcslip::Case first = arcslip::read_case(folder.write("case.toml", shown[0]));
  const arcslip::Case figure_8 = arcslip::read_case(source + "/problems/figure_8.toml");
  CHECK(first.resolved == figure_8.resolved);
  write_sector(folder, "rotor", bladed_disk(), "");
  write_sector(folder, "ring", lumped_ring(), "");
  const std::string range = "[branch]\nparameter = \"eta\"\nfrom = 100.0\nto = 200.0\n";
  CHECK_NOTHROW(arcslip::read_case(folder.write("sector.toml", shown[2] + range)));
  CHECK_THAT(read(source + "/problems/cubic_fold_curve.toml"), ContainsSubstring(shown[1]));
  CHECK_THAT(read(source + "/problems/chart.toml"), ContainsSubstring(shown[3]));
  CHECK_THAT(read(source + "/problems/rotor_ring.toml"), ContainsSubstring(shown[4]));
}

TEST_CASE("Every case file stands in the README's table") {
  const std::string readme = read(source + "/README.md");
  for (const auto& entry : std::filesystem::directory_iterator(source + "/problems")) {
    if (entry.path().extension() != ".toml") continue;
    INFO(entry.path());
    CHECK_THAT(readme, ContainsSubstring(fmt::format("`{}`", entry.path().stem().string())));
  }
}
