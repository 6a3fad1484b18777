// The way from a mesh to a case, with gmsh and CalculiX themselves, as problems/export/README.md has it.

#include <fmt/format.h>

#include <filesystem>
#include <map>
#include <sstream>

#include "arcslip/assembly/sector_pair.hpp"
#include "arcslip/cases/case_file.hpp"
#include "catch.hpp"
#include "mistakes.hpp"
#include "program.hpp"

using namespace arcslip;
using testing::read;
using testing::replaced;

namespace {

const std::string exports = testing::source_folder() + "/problems/export";

/// The indented blocks of a text, each without its indent.
std::vector<std::string> indented(const std::string& text) {
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
    for (const auto& entry : std::filesystem::directory_iterator(exports)) {
      if (entry.path().extension() != ".md")
        folder_.write(entry.path().filename().string(), read(entry.path().string()));
    }
  }

  testing::Outcome run(const std::string& commands) const {
    return testing::shell(fmt::format("cd '{}' && arcslip() {{ '{}' \"$@\"; }} && {{ {}\n}}",
                                      folder_.path("."), testing::program, chained(commands)));
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

  testing::TemporaryFolder folder_;
};

/// The same deck with ccx's own cyclic symmetry in place of the matrices, under so many waves.
std::string with_own_frequencies(const std::string& deck, Index first, Index last) {
  const std::size_t second = deck.find("*STEP, PERTURBATION");
  REQUIRE(second != std::string::npos);
  return deck.substr(0, second) +
         fmt::format(
             "*STEP, PERTURBATION\n*FREQUENCY\n6\n*SELECT CYCLIC SYMMETRY MODES, NMIN={}, "
             "NMAX={}\n*END STEP\n",
             first, last);
}

/// What ccx prints in JOB.dat, by the wave number; every frequency comes twice.
std::map<Index, std::vector<double>> printed_frequencies(const std::string& path) {
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

const SectorPair& sectors_of(const Case& input) {
  return dynamic_cast<const SectorPair&>(*input.branches.front().problem.system.structures);
}

/// Frequencies of one of the two under a wave; that their response is right the program has compared.
SectorModes modes(const FiniteSector& sector, Index wave_number) {
  ModesRequest request{1000, 6000, 1e-6, Loss{.structural = 1e-3}};
  request.compared = false;
  return sector_modes(sector, {wave_number, 12}, request);
}

void check_frequencies(const Workshop& workshop, const std::string& deck, Index first, Index last) {
  workshop.write("own.inp", with_own_frequencies(deck, first, last));
  REQUIRE(workshop.run("ccx own\n").status == 0);
  const Case input = read_case(workshop.path("study/case.toml"));
  const auto expected = printed_frequencies(workshop.path("own.dat"));
  REQUIRE(std::ssize(expected) == last - first + 1);
  for (const auto& [n, frequencies] : expected) {
    const SectorModes found = modes(sectors_of(input).base().sector, n);
    REQUIRE(frequencies.size() == 3);
    for (std::size_t k = 0; k < 3; ++k)  // ccx prints seven digits
      CHECK_THAT(found.frequencies[k], WithinRel(frequencies[k], 5e-7));
  }
}

}  // namespace

TEST_CASE("The guide's commands lead from a mesh to a case whose modes are those that CalculiX finds",
          "[export][numbers][outside]") {
  const std::string guide = read(exports + "/README.md");
  const std::vector<std::string> shown = indented(guide);
  REQUIRE(shown.size() >= 3);
  const Workshop workshop;
  const testing::Outcome outcome = workshop.run(shown[0]);
  CHECK(outcome.err.empty());
  REQUIRE(outcome.status == 0);
  CHECK_THAT(outcome.out, ContainsSubstring("study/case.toml: valid"));
  CHECK_THAT(outcome.out, ContainsSubstring("1 branch, "));
  CHECK_THAT(outcome.out, !ContainsSubstring("*WARNING"));

  const std::string rotor = read(exports + "/rotor.inp");
  CHECK_THAT(rotor, ContainsSubstring(shown[1]));
  CHECK_THAT(read(exports + "/ring.inp"), ContainsSubstring(shown[2]));
  check_frequencies(workshop, rotor, 0, 3);
  // The places of its dofs, each face turned into the other.
  CHECK(workshop.run("arcslip modes study/case.toml --shapes -o modes --quiet\n").status == 0);
  CHECK_THAT(read(workshop.path("modes/shapes/n3_base_1.vtu")), ContainsSubstring("mode_imaginary"));

  // The ring has the stiffness of no support: fourteen digits tell which motions are free.
  const Case input = read_case(workshop.path("study/case.toml"));
  for (const Index n : {0, 1, 2})
    CHECK(modes(sectors_of(input).damper()->sector, n).free_squares.size() == (n < 2 ? 2 : 0));
}

TEST_CASE("At rest the same deck gives the matrices of the unstressed structure", "[export][outside]") {
  const std::vector<std::string> shown = indented(read(exports + "/README.md"));
  const Workshop workshop;
  const std::string rest = replaced(read(exports + "/rotor.inp"), "CENTRIF, 1e6", "CENTRIF, 0");
  workshop.write("rotor.inp", rest);
  const std::string commands = shown[0].substr(0, shown[0].find("gmsh -3 -format inp -v 1 -o ring"));
  REQUIRE(workshop.run(commands).status == 0);
  check_frequencies(workshop, rest, 3, 3);
}

TEST_CASE("What a deck holds in the step that stores the matrices is refused", "[export][outside]") {
  const auto [from, to] =
      GENERATE(table<std::string, std::string>({{", CYCMPC=INACTIVE", ""}, {"*BOUNDARY, OP=NEW\n", ""}}));
  const std::vector<std::string> shown = indented(read(exports + "/README.md"));
  const Workshop workshop;
  workshop.write("rotor.inp", replaced(read(exports + "/rotor.inp"), from, to));
  const testing::Outcome outcome =
      workshop.run(shown[0].substr(0, shown[0].find("gmsh -3 -format inp -v 1 -o ring")));
  CHECK(outcome.status == 1);
  CHECK(testing::is_one_line(outcome.err));
  CHECK_THAT(outcome.err, ContainsSubstring("have no dofs: in the step that stores the matrices free all"));
}
