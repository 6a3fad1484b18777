// Sectors that turn, out of CalculiX: against its own frequencies at other speeds, and against a whole wheel
// under Coriolis' forces, which it takes without cyclic symmetry alone.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <set>

#include "arcslip/assembly/sector_pair.hpp"
#include "arcslip/cases/case_file.hpp"
#include "calculix.hpp"
#include "catch.hpp"
#include "mistakes.hpp"
#include "plotting.hpp"

using namespace arcslip;
using namespace arcslip::testing;

namespace {

/// What the guide runs for sectors that turn.
std::string turning_commands(const std::vector<std::string>& shown) {
  const auto found = std::find_if(shown.begin(), shown.end(), [](const std::string& block) {
    return block.find("--at-rest rest") != std::string::npos;
  });
  REQUIRE(found != shown.end());
  const std::string drawing = "arcslip plot turning/modes\n";
  return has_matplotlib() ? *found : replaced(*found, drawing, "");
}

/// Of the guide's first commands those that mesh both sectors and store the rotor's matrices.
std::string meshing(const std::string& commands) {
  const std::size_t ring = commands.find("gmsh -3 -format inp -v 1 -o ring");
  return commands.substr(0, commands.find("python3 sector_matrices")) +
         commands.substr(ring, commands.find("ccx ring") - ring);
}

/// ccx' own frequencies of the rotor at a speed, in Hz, of all its waves.
std::map<Index, std::vector<double>> own_frequencies(const Workshop& workshop, double speed_squared) {
  const std::string deck = replaced(read(export_folder + "/rotor.inp"), "CENTRIF, 1e6",
                                    fmt::format("CENTRIF, {:e}", speed_squared));
  workshop.write("own.inp", deck.substr(0, deck.find("*STEP, PERTURBATION")) +
                                "*STEP, PERTURBATION\n*FREQUENCY\n6\n"
                                "*SELECT CYCLIC SYMMETRY MODES, NMIN=0, NMAX=6\n*END STEP\n");
  REQUIRE(workshop.run("ccx own\n").status == 0);
  return printed_frequencies(workshop.path("own.dat"));
}

/// The lowest three in Hz at the square of a speed, without Coriolis' forces.
std::vector<double> split_frequencies(const FiniteSector& sector, Index wave_number, double speed_squared) {
  FiniteSector still = sector;
  still.stiffness += speed_squared * sector.stiffness_speed2;
  still.stiffness_speed2 = still.gyroscopic = SparseMatrix();
  ModesRequest request{1000, 13000, 1e-6, Loss{.structural = 1e-3}};
  request.compared = false;
  std::vector<double> found = sector_modes(still, {wave_number, 12}, request).frequencies;
  found.resize(3);
  return found;
}

/// A wheel of 12 sectors in bricks of eight nodes: rims on spokes, with a blade each, moving in its plane.
struct Wheel {
  static constexpr int sectors = 12;
  static constexpr int columns = 4;  ///< of bricks in a sector
  static constexpr std::array<double, 5> radii{0.03, 0.06, 0.09, 0.1, 0.13};
  int count = 1;  ///< of sectors; all of them close the circle

  bool is_whole() const { return count == sectors; }
  static bool has_brick(int column, int row) {
    return row == 2 || (row < 2 && column == 1) || (row == 3 && column == 2);
  }
  int node(int column, int row, int z) const {
    return 1 + z + 2 * (row + 5 * (is_whole() ? column % (columns * count) : column));
  }
};

using Place = std::array<int, 3>;  // column, row, z

/// Nodes, bricks, sets and material.
std::string wheel_mesh(const Wheel& wheel) {
  std::string bricks = "*ELEMENT, TYPE=C3D8, ELSET=ALL\n";
  std::map<int, Place> used;
  int number = 0;
  for (int column = 0; column < Wheel::columns * wheel.count; ++column) {
    for (int row = 0; row < 4; ++row) {
      if (!Wheel::has_brick(column % Wheel::columns, row)) continue;
      bricks += fmt::format("{}", ++number);
      for (const auto& [r, c, z] : std::initializer_list<Place>{
               {0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}}) {
        const int node = wheel.node(column + c, row + r, z);
        used.try_emplace(node, Place{column + c, row + r, z});
        bricks += fmt::format(", {}", node);
      }
      bricks += "\n";
    }
  }
  std::string nodes = "*NODE\n";
  std::map<std::string, std::string> sets;
  for (const auto& [node, place] : used) {
    const auto [column, row, z] = place;
    const double angle = 2 * std::numbers::pi * column / (Wheel::columns * Wheel::sectors);
    const double radius = Wheel::radii[static_cast<std::size_t>(row)];
    nodes += fmt::format("{}, {:.12e}, {:.12e}, {}\n", node, radius * std::cos(angle),
                         radius * std::sin(angle), 0.01 * z);
    const bool on_right = !wheel.is_whole() && column == Wheel::columns;
    const auto put = [&](const char* set, bool inside) {
      if (inside) sets[set] += fmt::format("{},\n", node);
    };
    put("HUB", row == 0);
    put("EVERY", true);
    put("FLAT", !on_right);
    put("LEFT", !wheel.is_whole() && column == 0);
    put("RIGHT", on_right);
    put("TIP", row == 4);
  }
  std::string text = nodes + bricks;
  for (const auto& [name, members] : sets) text += fmt::format("*NSET, NSET={}\n{}", name, members);
  return text +
         "*MATERIAL, NAME=STEEL\n*ELASTIC\n210e9, 0.3\n*DENSITY\n7850\n"
         "*SOLID SECTION, ELSET=ALL, MATERIAL=STEEL\n";
}

const std::string at_speed = "*DLOAD\nALL, CENTRIF, 250000, 0, 0, 0, 0, 0, 1\n";  // 500 rad/s

const std::string state = "*STEP\n*STATIC\n*BOUNDARY\nHUB, 1, 3\nFLAT, 3, 3\n" + at_speed + "*END STEP\n";

/// ccx' frequencies in Hz of the whole wheel as it turns, in the space of so many modes.
std::vector<double> wheel_frequencies(const Workshop& workshop, int modes) {
  workshop.write("wheel.inp",
                 wheel_mesh({Wheel::sectors}) + state +
                     fmt::format("*STEP, PERTURBATION\n*FREQUENCY, STORAGE=YES\n{}\n*END STEP\n*STEP, "
                                 "PERTURBATION\n*COMPLEX FREQUENCY, CORIOLIS\n24\n",
                                 modes) +
                     at_speed + "*END STEP\n");
  REQUIRE(workshop.run("ccx wheel\n").status == 0);
  const std::string printed = read(workshop.path("wheel.dat"));
  std::istringstream in(printed.substr(printed.rfind("E I G E N V A L U E")));
  std::vector<double> found;
  for (std::string line; std::getline(in, line) && line.find("P A R T I C") == std::string::npos;) {
    std::istringstream numbers(line);
    int mode = 0;
    double radians = 0, frequency = 0, imaginary = 0;
    if (numbers >> mode >> radians >> frequency >> imaginary) found.push_back(frequency);
  }
  return found;
}

/// The wheel's case at its speed, by the guide's way.
void make_wheel_case(const Workshop& workshop) {
  const std::string stored =
      wheel_mesh({}) +
      "*SURFACE, NAME=BEHIND, TYPE=NODE\nLEFT\n*SURFACE, NAME=AHEAD, TYPE=NODE\nRIGHT\n*TIE, CYCLIC "
      "SYMMETRY, NAME=FACES, POSITION TOLERANCE=1e-6\nAHEAD, BEHIND\n*CYCLIC SYMMETRY MODEL, N=12, "
      "TIE=FACES\n0, 0, 0, 0, 0, 1\n" +
      state +
      "*STEP, PERTURBATION\n*FREQUENCY, SOLVER=MATRIXSTORAGE, CYCMPC=INACTIVE\n*BOUNDARY, OP=NEW\n*END "
      "STEP\n";
  workshop.write("sector.inp", stored);
  workshop.write("still.inp", replaced(stored, "250000", "0"));
  const Outcome outcome = workshop.run(
      "ccx sector\nccx still\npython3 sector_matrices.py sector --at-rest still --speed-squared 250000 "
      "--deck "
      "sector.inp --sectors 12 --left LEFT --right RIGHT --hold HUB --hold EVERY:z --contact TIP:t --load "
      "TIP:t:1 --wave-number 1 --contact-stiffness 1 --preload 1 --eta 1000 14000 -o wheel\n");
  CAPTURE(outcome.err);
  REQUIRE(outcome.status == 0);
}

struct WheelMode {
  Index wave_number;
  double frequency;
};

/// Those of arcslip, in both directions.
std::vector<WheelMode> wheel_modes(const Workshop& workshop) {
  REQUIRE(workshop.run("arcslip modes wheel/case.toml -o modes --quiet\n").status == 0);
  std::vector<WheelMode> found;
  for (const auto& row : read_csv(workshop.path("modes/modes.csv"))) {
    if (row[1] == "base") found.push_back({std::stol(row[0]), std::stod(row[3])});
  }
  return found;
}

}  // namespace

TEST_CASE(
    "The guide's commands lead from CalculiX to a Campbell diagram, whose K_2 gives other speeds as well",
    "[export][numbers][outside][rotation][long]") {
  const std::vector<std::string> shown = indented(read(export_folder + "/README.md"));
  const Workshop workshop;
  REQUIRE(workshop.run(meshing(shown[0])).status == 0);
  const Outcome outcome = workshop.run(turning_commands(shown));
  CAPTURE(outcome.out, outcome.err);
  REQUIRE(outcome.status == 0);
  CHECK_THAT(outcome.out, ContainsSubstring("turning/case.toml: valid"));
  CHECK_THAT(outcome.out, ContainsSubstring("speed 159.155 (forward)"));
  CHECK_THAT(outcome.out, ContainsSubstring("turning/modes/modes.csv, turning/modes/campbell.csv"));
  CHECK_THAT(outcome.out, ContainsSubstring("none: damper: the stiffness K + Omega^2 K_2 is not positive"));

  const Case input = read_case(workshop.path("turning/case.toml"));
  const auto& pair = dynamic_cast<const SectorPair&>(*input.branches.front().problem.system.structures);
  const FiniteSector& rotor = pair.base().sector;
  const auto expected = own_frequencies(workshop, 0.49e6);  // between rest and the speed of the matrices
  REQUIRE(expected.size() == 7);
  for (const auto& [n, frequencies] : expected) {
    const std::vector<double> found = split_frequencies(rotor, n, 0.49e6);
    CAPTURE(n);
    for (std::size_t k = 0; k < 3; ++k)  // ccx prints seven digits
      CHECK_THAT(found[k], WithinRel(frequencies[k], 5e-7));
  }
  // Twice the speed is too fast for K_2 alone: the guide says by how much.
  const double fast = split_frequencies(rotor, 3, 4e6)[0] / own_frequencies(workshop, 4e6).at(3)[0] - 1;
  CHECK_THAT(fast, WithinAbs(-1.1e-5, 1e-6));
}

TEST_CASE("A ring out of CalculiX is split by its rotation as thin rings are",
          "[export][outside][rotation]") {
  const std::vector<std::string> shown = indented(read(export_folder + "/README.md"));
  const Workshop workshop;
  const std::string commands = turning_commands(shown);
  const std::size_t stored = commands.find("sed 's/CENTRIF, 1e6/CENTRIF, 0/' turning_ring");
  REQUIRE(workshop.run(meshing(shown[0])).status == 0);
  REQUIRE(workshop.run(commands.substr(stored, commands.find("python3", stored) - stored)).status == 0);
  // Held in its plane, where n = 3 is the lowest mode.
  const Outcome outcome = workshop.run(
      "python3 sector_matrices.py turning_ring --at-rest ring_rest --speed-squared 1e6 --deck "
      "turning_ring.inp "
      "--sectors 12 --left LEFT --right RIGHT --hold RING:z --contact GROOVE:t --load GROOVE:r:1 "
      "--wave-number 3 "
      "--contact-stiffness 1 --preload 1 --eta 500 2000 -o plane\n"
      "arcslip modes plane/case.toml --to 3 --set system.speed=0.01 -o rest --quiet\n"
      "arcslip modes plane/case.toml --to 3 --set system.speed=160 -o turns --quiet\n");
  CAPTURE(outcome.err);
  REQUIRE(outcome.status == 0);
  const auto lowest = [&](const std::string& folder, const std::string& wave) {
    const auto rows = read_csv(workshop.path(folder + "/modes.csv"));
    const auto found = std::find_if(rows.begin(), rows.end(),
                                    [&](const auto& row) { return row[0] == wave && row[1] == "base"; });
    REQUIRE(found != rows.end());
    return std::stod((*found)[3]);
  };
  const double speed = 160;
  const double rest = lowest("rest", "3");
  const double with = lowest("turns", "3");
  const double against = lowest("turns", "-3");
  // 4 n/(n^2 + 1) but for n^2 times thickness over radius, squared.
  CHECK_THAT((against - with) / speed, WithinRel(1.2, 0.01));
  // What lifts both: K_2 of the hoop's tension, less the softening, n^2 (n^2 - 3)/(n^2 + 1).
  CHECK_THAT((against * with - rest * rest) / (speed * speed), WithinRel(5.4, 0.02));
}

TEST_CASE(
    "Coriolis' forces split a wheel's waves as CalculiX finds them of the whole wheel, at five nodal "
    "diameters",
    "[export][numbers][outside][rotation]") {
  const Workshop workshop;
  make_wheel_case(workshop);
  const std::vector<WheelMode> modes = wheel_modes(workshop);
  const std::vector<double> expected = wheel_frequencies(workshop, 60);
  REQUIRE(expected.size() == 24);
  const auto nearest = [&](double frequency) {
    return *std::min_element(modes.begin(), modes.end(), [&](const WheelMode& a, const WheelMode& b) {
      return std::abs(a.frequency - frequency) < std::abs(b.frequency - frequency);
    });
  };
  // ccx takes what lies within 0.2 % for one; each of the rest is a mode, the lowest but for ccx' own
  // rounding.
  std::set<Index> met;
  for (const double frequency : expected) {
    const WheelMode mode = nearest(frequency);
    CAPTURE(mode.wave_number, mode.frequency);
    CHECK_THAT(mode.frequency, WithinRel(frequency, 2e-5));
    if (std::abs(mode.frequency / frequency - 1) < 1e-6) met.insert(mode.wave_number);
  }
  for (const Index n : {1, 2, 3, 4, 5}) CHECK((met.count(n) == 1 && met.count(-n) == 1));
  // Fewer modes, less of the coupling.
  double farthest = 0;
  for (const double frequency : wheel_frequencies(workshop, 40)) {
    if (frequency > 9000)
      farthest = std::max(farthest, std::abs(nearest(frequency).frequency / frequency - 1));
  }
  CHECK(farthest > 1e-6);
  CHECK(farthest < 1e-5);
}

TEST_CASE("Two stored states that are not of one sector make no matrices of rotation",
          "[export][outside][rotation]") {
  const Workshop workshop;
  make_wheel_case(workshop);
  const std::string command =
      "python3 sector_matrices.py sector --deck sector.inp --sectors 12 --left LEFT --right RIGHT -o new";
  const auto [options, change, message] = GENERATE(table<std::string, std::string, std::string>(
      {{" --at-rest still", "", "--at-rest and --speed-squared, above 0, go together"},
       {" --speed-squared 4", "", "--at-rest and --speed-squared, above 0, go together"},
       {" --at-rest still --speed-squared -4", "", "--at-rest and --speed-squared, above 0, go together"},
       {" --at-rest still --speed-squared 4", "head -n 30 still.dof > s.dof && mv s.dof still.dof\n",
        "still.dof has not the dofs of sector.dof"},
       {" --at-rest still --speed-squared 4", "head -n 100 still.sti > s.sti && mv s.sti still.sti\n",
        "the stiffness at rest is that of another mesh than the turning one"},
       {" --at-rest still --speed-squared 4", "sed -i 's/^1 1 .*/1 1 7.0/' sector.mas\n",
        "the mass of rows 1 and 1 is not the same in x, y and z"}}));
  CAPTURE(options, change);
  if (!change.empty()) REQUIRE(workshop.run(change).status == 0);
  const Outcome outcome = workshop.run(command + options + "\n");
  CHECK(outcome.status == 1);
  CHECK(is_one_line(outcome.err));
  CHECK_THAT(outcome.err, ContainsSubstring(message));
  CHECK_FALSE(std::filesystem::exists(workshop.path("new")));
}
