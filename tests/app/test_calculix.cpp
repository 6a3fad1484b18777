// The way from a mesh to a case, with gmsh and CalculiX themselves, as problems/export/README.md has it.

#include <fmt/format.h>

#include "arcslip/assembly/sector_pair.hpp"
#include "arcslip/cases/case_file.hpp"
#include "calculix.hpp"
#include "catch.hpp"
#include "mistakes.hpp"

using namespace arcslip;
using namespace arcslip::testing;

namespace {

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

const SectorPair& sectors_of(const Case& input) {
  return dynamic_cast<const SectorPair&>(*input.branches.front().problem.system.structures);
}

/// Frequencies of one of the two under a wave; that their response is right the program has compared.
SectorModes modes(const FiniteSector& sector, Index wave_number) {
  ModesRequest request{1000, 13000, 1e-6, Loss{.structural = 1e-3}};
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
  const std::string guide = read(export_folder + "/README.md");
  const std::vector<std::string> shown = indented(guide);
  REQUIRE(shown.size() >= 3);
  const Workshop workshop;
  const Outcome outcome = workshop.run(shown[0]);
  CHECK(outcome.err.empty());
  REQUIRE(outcome.status == 0);
  CHECK_THAT(outcome.out, ContainsSubstring("study/case.toml: valid"));
  CHECK_THAT(outcome.out, ContainsSubstring("1 branch, "));
  CHECK_THAT(outcome.out, !ContainsSubstring("*WARNING"));

  const std::string rotor = read(export_folder + "/rotor.inp");
  CHECK_THAT(rotor, ContainsSubstring(shown[1]));
  CHECK_THAT(read(export_folder + "/ring.inp"), ContainsSubstring(shown[2]));
  check_frequencies(workshop, rotor, 0, 6);
  // The places of its dofs, each face turned into the other.
  CHECK(workshop.run("arcslip modes study/case.toml --shapes -o modes --quiet\n").status == 0);
  CHECK_THAT(read(workshop.path("modes/shapes/n3_base_1.vtu")), ContainsSubstring("mode_imaginary"));

  // The ring has the stiffness of no support: fourteen digits tell which motions are free.
  const Case input = read_case(workshop.path("study/case.toml"));
  for (const Index n : {0, 1, 2})
    CHECK(modes(sectors_of(input).damper()->sector, n).free_squares.size() == (n < 2 ? 2 : 0));
}

TEST_CASE("At rest the same deck gives the matrices of the unstressed structure", "[export][outside]") {
  const std::vector<std::string> shown = indented(read(export_folder + "/README.md"));
  const Workshop workshop;
  const std::string rest = replaced(read(export_folder + "/rotor.inp"), "CENTRIF, 1e6", "CENTRIF, 0");
  workshop.write("rotor.inp", rest);
  const std::string commands = shown[0].substr(0, shown[0].find("gmsh -3 -format inp -v 1 -o ring"));
  REQUIRE(workshop.run(commands).status == 0);
  check_frequencies(workshop, rest, 3, 3);
}

TEST_CASE("What a deck holds in the step that stores the matrices is refused", "[export][outside]") {
  const auto [from, to] =
      GENERATE(table<std::string, std::string>({{", CYCMPC=INACTIVE", ""}, {"*BOUNDARY, OP=NEW\n", ""}}));
  const std::vector<std::string> shown = indented(read(export_folder + "/README.md"));
  const Workshop workshop;
  workshop.write("rotor.inp", replaced(read(export_folder + "/rotor.inp"), from, to));
  const Outcome outcome = workshop.run(shown[0].substr(0, shown[0].find("gmsh -3 -format inp -v 1 -o ring")));
  CHECK(outcome.status == 1);
  CHECK(is_one_line(outcome.err));
  CHECK_THAT(outcome.err, ContainsSubstring("have no dofs: in the step that stores the matrices free all"));
}
