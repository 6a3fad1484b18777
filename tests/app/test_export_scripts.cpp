// The scripts that bring matrices out of finite-element programs, on a small example in the form of what
// these write.

#include <fmt/format.h>

#include <numbers>

#include "arcslip/cases/case_file.hpp"
#include "arcslip/sectors/matrix_market.hpp"
#include "catch.hpp"
#include "places.hpp"
#include "program.hpp"
#include "sector_examples.hpp"

using namespace arcslip;
using testing::read;

namespace {

constexpr double angle = std::numbers::pi / 4;  // eight sectors

struct Node {
  int name;
  double radius;
  double theta;
  double z;
};

/// Two nodes on each face, one between; named as meshes are, in no order.
const std::vector<Node> nodes{{7, 1, 0.2, 0},
                              {3, 2, 0.2, 0.5},
                              {12, 1.5, 0.2 + angle / 3, 0.1},
                              {9, 2, 0.2 + angle, 0.5},
                              {4, 1, 0.2 + angle, 0}};

/// Symmetric, with no pattern that an exchange of rows would leave as it is; in r, t, z of each node.
Matrix cylindrical(double seed) {
  Matrix matrix(15, 15);
  for (Index i = 0; i < 15; ++i) {
    for (Index k = 0; k <= i; ++k) {
      matrix(i, k) = matrix(k, i) =
          std::sin(seed * static_cast<double>(1 + i * i + 17 * k)) + (i == k ? 20 : 0);
    }
  }
  return matrix;
}

/// To x, y, z about the axis z.
Matrix cartesian(const Matrix& matrix) {
  Matrix turn = Matrix::Identity(15, 15);
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const double c = std::cos(nodes[i].theta), s = std::sin(nodes[i].theta);
    turn.block<2, 2>(static_cast<Index>(3 * i), static_cast<Index>(3 * i)) << c, -s, s, c;
  }
  return turn * matrix * turn.transpose();
}

std::string deck() {
  std::string text = "** a comment\n*NODE, NSET=ALL\n";
  for (const Node& n : nodes) {
    text += fmt::format("{}, {:.17g}, {:.17g}, {:.17g}\n", n.name, n.radius * std::cos(n.theta),
                        n.radius * std::sin(n.theta), n.z);
  }
  return text +
         "*NSET, NSET=Left\n7, 3\n*NSET,NSET=RIGHT\n4\n9,\n*NSET, NSET=GROOVE\n9\n12\n3\n"
         "*Nset, nset=HUB, generate\n4, 7, 3\n";
}

std::string upper_triangle(const Matrix& matrix) {
  std::string text;
  for (Index k = 0; k < matrix.cols(); ++k) {
    for (Index i = 0; i <= k; ++i) text += fmt::format("{} {} {:20.13e}\n", i + 1, k + 1, matrix(i, k));
  }
  return text;
}

const std::string folder_of_scripts = testing::source_folder() + "/problems/export";

testing::Outcome convert(const testing::TemporaryFolder& folder, const std::string& options) {
  return testing::shell(
      fmt::format("python3 '{0}/sector_matrices.py' '{1}' --deck '{1}.inp' --sectors 8 --left LEFT --right "
                  "right {2} -o '{3}'",
                  folder_of_scripts, folder.path("job"), options, folder.path("out")));
}

void write_job(const testing::TemporaryFolder& folder) {
  folder.write("job.sti", upper_triangle(cartesian(cylindrical(1))));
  folder.write("job.mas", upper_triangle(cartesian(cylindrical(2))));
  folder.write("job.inp", deck());
  std::string dofs;
  for (const Node& n : nodes) dofs += fmt::format("{0}.1\n{0}.2\n{0}.3\n", n.name);
  folder.write("job.dof", dofs);
}

Matrix matrix(const testing::TemporaryFolder& folder, const std::string& name) {
  return read_matrix_market(read(folder.path("out/" + name)), name);
}

}  // namespace

TEST_CASE("Stored matrices of CalculiX come out in cylindrical directions, with boundaries in pairs",
          "[outside]") {
  const testing::TemporaryFolder folder;
  write_job(folder);
  const testing::Outcome outcome =
      convert(folder, "--contact groove:z --contact groove:t --load LEFT:r:2 --load ALL:z --wave-number 3");
  CHECK(outcome.err.empty());
  REQUIRE(outcome.status == 0);
  // 14 digits are written, of numbers up to 25.
  CHECK((matrix(folder, "base_stiffness.mtx") - cylindrical(1)).cwiseAbs().maxCoeff() < 1e-11);
  CHECK((matrix(folder, "base_mass.mtx") - cylindrical(2)).cwiseAbs().maxCoeff() < 1e-11);
  CHECK(read(folder.path("out/base_left.txt")) == "1\n2\n3\n4\n5\n6\n");
  CHECK(read(folder.path("out/base_right.txt")) == "13\n14\n15\n10\n11\n12\n");
  // Contact node 9 is on the right face, where it is that of the next sector.
  CHECK(read(folder.path("out/base_contact.txt")) == "5\n6\n8\n9\n");
  const auto load = testing::read_csv(folder.path("out/base_load.txt"));
  REQUIRE(load.size() == 6);  // heading; 2 in the direction r, 3 in the direction z
  CHECK(load[1][0] == "1 2.0 0.0");
  std::istringstream last(load[5][0]);  // 3 waves, a third of a sector's angle: e^{-j pi/4}
  double dof = 0, real = 0, imaginary = 0;
  last >> dof >> real >> imaginary;
  CHECK(dof == 9);
  CHECK_THAT(real, WithinAbs(std::sqrt(0.5), 1e-14));
  CHECK_THAT(imaginary, WithinAbs(-std::sqrt(0.5), 1e-14));
}

TEST_CASE("Two states tell what rotation adds to the stiffness, and the mass Coriolis' forces",
          "[outside][rotation]") {
  const testing::TemporaryFolder folder;
  write_job(folder);
  Matrix masses(5, 5);  // of pairs of nodes, the same in all directions
  for (Index i = 0; i < 25; ++i)
    masses(i / 5, i % 5) = std::cos(static_cast<double>(i / 5 + i % 5)) + (i % 6 == 0);
  Matrix mass = Matrix::Zero(15, 15);
  Matrix forces = mass;  // 2 m e x v
  for (Index i = 0; i < 5; ++i) {
    for (Index k = 0; k < 5; ++k) {
      mass.block<3, 3>(3 * i, 3 * k).diagonal().setConstant(masses(i, k));
      forces(3 * i, 3 * k + 1) = -2 * masses(i, k);
      forces(3 * i + 1, 3 * k) = 2 * masses(i, k);
    }
  }
  folder.write("job.mas", upper_triangle(mass));
  folder.write("rest.sti", upper_triangle(cartesian(cylindrical(3))));
  folder.write("rest.dof", read(folder.path("job.dof")));
  const std::string options = fmt::format("--at-rest '{}' --speed-squared 4", folder.path("rest"));
  REQUIRE(convert(folder, options + " --contact LEFT:z --load LEFT:z").status == 0);
  CHECK((matrix(folder, "base_stiffness.mtx") - cylindrical(3)).cwiseAbs().maxCoeff() < 1e-11);
  CHECK((matrix(folder, "base_stiffness_speed2.mtx") - (cylindrical(1) - cylindrical(3)) / 4)
            .cwiseAbs()
            .maxCoeff() < 1e-11);
  const Matrix gyroscopic = matrix(folder, "base_gyroscopic.mtx");
  CHECK((cartesian(gyroscopic) - forces).cwiseAbs().maxCoeff() < 1e-11);
  CHECK((gyroscopic + gyroscopic.transpose()).norm() == 0);
  const std::string text = read(folder.path("out/case.toml"));
  CHECK_THAT(text, ContainsSubstring("\nspeed = 0.318309886184 "));  // 2 radians
  CHECK_THAT(text, ContainsSubstring("gyroscopic = \"base_gyroscopic.mtx\"\n"));
  REQUIRE(convert(folder, options + " --contact LEFT:z --name damper").status == 0);
  CHECK_THAT(read(folder.path("out/case.toml")), ContainsSubstring("\"damper_stiffness_speed2.mtx\"\n"));
}

TEST_CASE("Held dofs are left out of the matrices and of the boundaries", "[outside]") {
  const testing::TemporaryFolder folder;
  write_job(folder);
  REQUIRE(convert(folder, "--hold HUB --hold GROOVE:r --contact GROOVE:z --name ring").status == 0);
  const std::vector<Index> kept{4, 5, 7, 8, 10, 11};  // node 3 in t, z; node 12 in t, z; node 9 in t, z
  const Matrix expected = cylindrical(1)(kept, kept);
  CHECK((matrix(folder, "ring_stiffness.mtx") - expected).cwiseAbs().maxCoeff() < 1e-11);
  CHECK(read(folder.path("out/ring_left.txt")) == "1\n2\n");
  CHECK(read(folder.path("out/ring_right.txt")) == "5\n6\n");
  CHECK(read(folder.path("out/ring_contact.txt")) == "2\n4\n");
}

TEST_CASE("The case file is written once, and takes the damper's table", "[outside]") {
  const testing::TemporaryFolder folder;
  write_job(folder);
  const std::string numbers = " --contact-stiffness 2e9 --preload 12.5 --eta 0.01 3";
  const bool damper_first = GENERATE(false, true);
  const std::string base = "--contact LEFT:z --load GROOVE:z:4 --wave-number 2" + numbers;
  const std::string damper = "--contact LEFT:z --name damper";
  CHECK(convert(folder, damper_first ? damper : base).status == 0);
  CHECK(convert(folder, damper_first ? base : damper).status == 0);
  const std::string path = folder.path("out/case.toml");
  const std::string text = read(path);
  const Case input = read_case(path);
  const SystemParameters& system = input.branches.front().problem.system;
  CHECK(system.wave_number == 2);
  CHECK(system.elements == 8);
  CHECK(system.contacts.size() == 2);
  CHECK(system.contacts.front().stiffness == 2e9);
  CHECK(system.preload == 12.5);
  CHECK_FALSE(system.fixed_damper);
  CHECK(convert(folder, base).status == 0);
  CHECK(convert(folder, damper).status == 0);
  CHECK(read(path) == text);
}

TEST_CASE("What the case file still wants stands in it as a comment", "[outside]") {
  const testing::TemporaryFolder folder;
  write_job(folder);
  CHECK(convert(folder, "--contact LEFT:z --load GROOVE:z").status == 0);
  const std::string text = read(folder.path("out/case.toml"));
  for (const char* key : {"contact_stiffness", "preload", "from", "to"})
    CHECK_THAT(text, ContainsSubstring(fmt::format("\n# {} = ?", key)));
}

TEST_CASE("Matrices pass through the script without being held in memory", "[outside]") {
  // A ring of 2000 nodes, each tied to eight before it: 9 MB of stiffness.
  constexpr int count = 2000;
  const testing::TemporaryFolder folder;
  std::string nodes = "*NODE\n";
  std::string dofs;
  std::string entries;
  for (int i = 0; i < count; ++i) {
    const double theta = angle * i / (count - 1);
    nodes += fmt::format("{}, {:.17g}, {:.17g}, 0\n", i + 1, std::cos(theta), std::sin(theta));
    for (int p = 0; p < 3; ++p) {
      dofs += fmt::format("{}.{}\n", i + 1, p + 1);
      for (int k = std::max(0, 3 * (i - 8)); k <= 3 * i + p; ++k)
        entries += fmt::format("{} {} {:20.13e}\n", k + 1, 3 * i + p + 1, k == 3 * i + p ? 50.0 : -1.0);
    }
  }
  folder.write("job.sti", entries);
  folder.write("job.mas", entries);
  folder.write("job.dof", dofs);
  folder.write("job.inp", nodes + fmt::format("*NSET, NSET=LEFT\n1\n*NSET, NSET=RIGHT\n{}\n", count));
  const testing::Outcome outcome = testing::shell(
      fmt::format("python3 -c 'import resource, subprocess, sys; subprocess.run(sys.argv[1:], check=True); "
                  "print(resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss)' "
                  "python3 '{0}/sector_matrices.py' '{1}' --deck '{1}.inp' --sectors 8 --left LEFT --right "
                  "RIGHT -o '{2}'",
                  folder_of_scripts, folder.path("job"), folder.path("out")));
  REQUIRE(outcome.status == 0);
  // Python itself takes 10 to 15 MB, nodes and their dofs some more; all entries in a dictionary 100 MB.
  CHECK(std::stol(outcome.out.substr(outcome.out.find('\n') + 1)) < 40'000);
}

TEST_CASE("Entries out of order, given twice or of unknown dofs are named with their line", "[outside]") {
  struct Example {
    std::string entries;
    const char* message;
  };
  const auto example = GENERATE(values<Example>({
      {"1 1 2\n1 4 1\n3 3 1\n", "job.sti:3: expected the larger of row and column in ascending order, got 3"},
      {"1 1 2\n2 1 1\n1 2 3\n", "job.sti:3: row 1, column 2 is given twice"},
      {"1 1 2\n1 16 1\n", "job.sti:2: expected rows and columns from 1 to 15 and a finite value"},
      {"1 1 nan\n", "job.sti:1: expected rows and columns from 1 to 15 and a finite value"},
      {"1 1\n", "job.sti:1: expected a row, a column and a value"},
  }));
  const testing::TemporaryFolder folder;
  write_job(folder);
  folder.write("job.sti", example.entries);
  const testing::Outcome outcome = convert(folder, "--contact LEFT:z");
  CHECK(outcome.status == 1);
  CHECK(testing::is_one_line(outcome.err));
  CHECK_THAT(outcome.err, ContainsSubstring(example.message));
  CHECK_FALSE(std::filesystem::exists(folder.path("out")));
}

TEST_CASE("Of a mesh the volume elements stay, and what is held but for the right face becomes a set",
          "[outside]") {
  const testing::TemporaryFolder folder;
  const std::string head =
      "*Heading\n mesh\n*NODE\n1, 1, 0, 0\n2, 1, 0, 1\n3, 0, 1, 0\n****** E L E M E N T S\n";
  const std::string surface =
      "*ELEMENT, type=CPS3, ELSET=Surface2\n1, 1, 2, 3\n*ELEMENT, type=T3D2, ELSET=Line1\n2, 1, 2\n";
  const std::string sets = "*NSET,NSET=RIGHT\n3,\n*NSET,NSET=HUB\n1, 2, 3\n";
  const auto convert_mesh = [&](const std::string& text, const std::string& options) {
    folder.write("mesh.inp", text);
    return testing::shell(fmt::format("python3 '{}/volume_mesh.py' '{}' {} -o '{}'", folder_of_scripts,
                                      folder.path("mesh.inp"), options, folder.path("mesh.msh")));
  };
  const std::string volume = "*ELEMENT, type=C3D4, ELSET=Volume1\n3, 1, 2, 3, 4\n*ELSET,ELSET=ROTOR\n3,\n";
  const testing::Outcome good = convert_mesh(head + surface + volume + sets, "--hold HUB");
  CHECK(good.status == 0);
  CHECK(good.out == "3 nodes; left out: 1 CPS3, 1 T3D2\n");
  CHECK(read(folder.path("mesh.msh")) ==
        "*NODE\n1, 1, 0, 0\n2, 1, 0, 1\n3, 0, 1, 0\n*ELEMENT, TYPE=C3D4, ELSET=ALL\n3, 1, 2, 3, 4\n" + sets +
            "*NSET, NSET=HUB_HELD\n1,\n2,\n");
  const testing::Outcome empty = convert_mesh(head + surface + sets, "");
  CHECK(empty.status == 1);
  CHECK(testing::is_one_line(empty.err));
  CHECK_THAT(empty.err, ContainsSubstring("has no volume elements: name the volume as well"));
  const testing::Outcome unknown = convert_mesh(head + volume + sets, "--hold RIM");
  CHECK(unknown.status == 1);
  CHECK_THAT(unknown.err, ContainsSubstring("the deck has no set of nodes RIM; it has HUB, RIGHT"));
}

TEST_CASE("What cannot be converted is named in one line", "[outside]") {
  struct Example {
    std::string options;
    const char* message;
  };
  const auto example = GENERATE(values<Example>({
      {"--contact NOWHERE:z", "no set of nodes NOWHERE; it has ALL, GROOVE, HUB, LEFT, RIGHT"},
      {"--contact GROOVE:x", "expected SET:directions of r, t, z, got 'GROOVE:x'"},
      {"--hold GROOVE --contact GROOVE:z", "node 12 of GROOVE is held in the direction z"},
      {"--hold LEFT", "of nodes 7 and 4, which are partners, one alone is held"},
      {"--left RIGHT --right LEFT", "degrees apart, expected 45: are left and right exchanged?"},
      {"--right HUB", "of the left boundary has 2 partners of the same r and z"},
      {"--axis x", "partners of the same r and z"},
  }));
  const testing::TemporaryFolder folder;
  write_job(folder);
  const testing::Outcome outcome = convert(folder, example.options);
  CHECK(outcome.status == 1);
  CHECK(testing::is_one_line(outcome.err));
  CHECK_THAT(outcome.err, ContainsSubstring(example.message));
  CHECK_FALSE(std::filesystem::exists(folder.path("out")));
}

TEST_CASE("Matrices of code_aster come out in the same form", "[outside]") {
  const testing::TemporaryFolder folder;
  // What the script asks of code_aster's objects, for a mesh of two nodes with one group.
  folder.write("study.py", R"(
import sys
sys.path.append(sys.argv[1])
from code_aster_matrices import write_matrices

class Numbering:
    multipliers = False
    def getNumberOfDOFs(self): return 6
    def isPhysicalDOF(self, row): return not (self.multipliers and row == 2)
    def getComponentFromDOF(self, row): return ("DX", "DY", "DZ")[row % 3]
    def getNodeFromDOF(self, row): return row // 3

class Matrix:
    def __init__(self, both): self.both = both
    def getDOFNumbering(self): return Numbering()
    def getValuesWithDescription(self):
        entries = [(2.5, 0, 0), (-1.25, 4, 0), (0.1, 5, 5)] + ([(-1.25, 0, 4)] if self.both else [])
        return (*zip(*entries), 6)

class Mesh:
    def getCoordinates(self): return self
    def getValues(self): return [1.0, 0.0, 0.5, 0.0, 2.0, 1 / 3]
    def getNodes(self, group): return [1]

write_matrices(sys.argv[2], Matrix(True), Matrix(False), Mesh(), ["RIM"])
Numbering.multipliers = True
write_matrices(sys.argv[2], Matrix(True), Matrix(False), Mesh(), ["RIM"])
)");
  const testing::Outcome outcome = testing::shell(
      fmt::format("python3 '{}' '{}' '{}'", folder.path("study.py"), folder_of_scripts, folder.path("job")));
  CHECK(outcome.status == 1);
  CHECK_THAT(outcome.err, ContainsSubstring("multipliers: leave DDL_IMPO out"));
  CHECK(read(folder.path("job.sti")) == "1 1 2.5\n5 1 -1.25\n6 6 0.1\n");
  CHECK(read(folder.path("job.mas")) == read(folder.path("job.sti")));
  CHECK(read(folder.path("job.dof")) == "1.1\n1.2\n1.3\n2.1\n2.2\n2.3\n");
  CHECK(read(folder.path("job.inp")) ==
        "*NODE\n1, 1.0, 0.0, 0.5\n2, 0.0, 2.0, 0.3333333333333333\n*NSET, NSET=RIM\n2\n");
}
