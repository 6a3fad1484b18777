#include <array>
#include <numbers>

#include "arcslip/cases/study_case.hpp"
#include "arcslip/continuation/linear/complex_sparse_factors.hpp"
#include "arcslip/elements/contact.hpp"
#include "arcslip/problems/response/forced_response.hpp"
#include "arcslip/results/results.hpp"
#include "arcslip/sectors/sector_solver.hpp"
#include "arcslip/structure/sector.hpp"
#include "case_runs.hpp"
#include "mistakes.hpp"
#include "paper_cases.hpp"
#include "paper_sectors.hpp"
#include "program.hpp"
#include "results/study_run.hpp"

using namespace arcslip;
using namespace arcslip::testing;

namespace {

const Loss paper_loss{2 * 1e-4 / 4, 0};  // of the base; of the damper 2e-4

/// Largest relative difference of two tables' numbers, of angles and of zeros the absolute one. The
/// residuals, which are rounding, and the iterations that they take do not count.
double difference(const std::vector<std::vector<std::string>>& a,
                  const std::vector<std::vector<std::string>>& b) {
  REQUIRE(a.size() == b.size());
  REQUIRE(a.front() == b.front());
  double worst = 0;
  for (std::size_t i = 1; i < a.size(); ++i) {
    for (std::size_t k = 0; k < a.front().size(); ++k) {
      const std::string& name = a.front()[k];
      if (name == "type" || name == "regime") {
        CHECK(a[i][k] == b[i][k]);
      } else if (name != "residual" && name != "iterations") {
        const double expected = std::stod(b[i][k]);
        const bool angle = name == "alpha" || name == "beta" || name == "psi";
        const double size = angle || expected == 0 ? 1 : std::abs(expected);
        const double error = std::abs(std::stod(a[i][k]) - expected) / size;
        worst = std::max(worst, error);
      }
    }
  }
  return worst;
}

}  // namespace

TEST_CASE("The paper's rods and beams, one element a sector, give the built-in models' branches") {
  const bool beams = GENERATE(false, true);
  const TemporaryFolder folder;
  // Both are to be solved far better than they are compared.
  const std::string exactly = std::string(over_all_eta) + "[continuation]\ntolerance = 1e-13\n";
  const std::string sector_case = folder.write("sector.toml", paper_system(folder, beams, 1) + exactly);
  const std::string built_in = folder.write(
      "case.toml",
      fmt::format("[system]\nmodel = \"{}\"\nwave_number = 1\nelements = 30\nmass_ratio = 5.0\n"
                  "frequency_ratio = 4.0\ninterface_stiffness = {:.17g}\nforce = 1.0\npreload = 1.0\n",
                  beams ? "beams" : "rods", interface_stiffness(beams)) +
          exactly);
  const double worst = difference(branches_csv(read_case(sector_case)), branches_csv(read_case(built_in)));
  CHECK(worst < 1e-10);
}

TEST_CASE("Ten elements a sector with dofs inside give the branches of a fifty-digit reduction") {
  const bool beams = GENERATE(false, true);
  const TemporaryFolder folder;
  const Case input = read_case(folder.write("sector.toml", paper_system(folder, beams, 10) + over_all_eta));
  const TracedBranch traced = std::move(trace(input.branches.front()).front());

  const PreciseReal a = propagation_constant(1, 3);
  const PreciseComplex forward{cos(a), -sin(a)};
  const Index boundary = beams ? 2 : 1;
  const auto modes = [&](const FiniteSector& sector, const Loss& loss) {
    const PreciseComplexVector load =
        sector.load.unaryExpr([](Complex f) { return PreciseComplex(f.real(), f.imag()); });
    const auto reduced = [&](const SparseMatrix& matrix) {
      return reduce_sector(Matrix(matrix).cast<PreciseReal>().eval(), boundary, forward);
    };
    return ModalModel(ReducedStructure{reduced(sector.mass), reduced(sector.stiffness),
                                       reduce_load(load, boundary, forward)},
                      0, loss);
  };
  const PaperSectors sectors = paper_sectors(beams, 10);
  const double k = interface_stiffness(beams) / 30;
  const problems::ForcedResponse problem(FrictionSystem{
      modes(sectors.base, paper_loss), modes(sectors.damper, Loss{2e-4, 0}), k, 80.0 / 30 / k});
  const continuation::Branch expected =
      continuation::trace(problem, problem.guess(0.5, 1), input.branches.front().options);
  REQUIRE(traced.branch.complete());
  REQUIRE(traced.branch.points.size() == expected.points.size());
  double worst = 0;
  Vector values;
  Vector expected_values;
  for (std::size_t i = 0; i < expected.points.size(); ++i) {
    const BranchPoint& found = traced.branch.points[i];
    const BranchPoint& known = expected.points[i];
    CHECK(found.type == known.type);
    traced.base.problem->observe(found.unknowns, found.parameters, found.regime, values);
    problem.observe(known.unknowns, known.parameters, known.regime, expected_values);
    worst = std::max(worst, std::abs(found.parameters(0) / known.parameters(0) - 1));
    for (const Index column : {0, 3, 4})
      worst = std::max(worst, std::abs(values(column) / expected_values(column) - 1));
  }
  CHECK(worst < 1e-10);
}

namespace {

/// The lumped bladed disk with a ring of one dof a sector that rubs on the disk, of N sectors.
struct RubbedDisk {
  FiniteSector disk = checked(bladed_disk());
  FiniteSector ring = lumped_ring();
  double loss = 2e-3;
  double k = 3e5;

  std::string system(const TemporaryFolder& folder, Index wave_number, Index sectors) const {
    return fmt::format(
               "[system]\nmodel = \"sector\"\nwave_number = {}\nsectors = {}\ncontact_stiffness = {:.17g}\n"
               "preload = 1.0\ndamping = {{ base = 1e-3, damper = 1e-3 }}\n",
               wave_number, sectors, k) +
           write_sector(folder, "base", disk, "output = [2, 3, 4]") +
           write_sector(folder, "damper", ring, "output = [2]");
  }
};

/// The whole ring of a sector as a matrix: sector i on the dofs first + i*size.
void assemble(const FiniteSector& sector, const SparseMatrix& matrix, Complex factor, Index first,
              Index sectors, std::vector<Eigen::Triplet<Complex>>& entries) {
  const SectorMap map = sector_map(sector);
  for (Index i = 0; i < sectors; ++i) {
    const auto dof = [&](Index local) {
      const auto at = static_cast<std::size_t>(local);
      const Index owner = map.is_right[at] ? (i + 1) % sectors : i;
      return static_cast<int>(first + owner * map.size + map.reduced[at]);
    };
    for (Index j = 0; j < matrix.outerSize(); ++j) {
      for (SparseMatrix::InnerIterator entry(matrix, j); entry; ++entry)
        entries.emplace_back(dof(entry.row()), dof(j), factor * entry.value());
    }
  }
}

}  // namespace

TEST_CASE("A whole ring of 300 sectors without reduction moves at every node as one sector tells") {
  constexpr Index N = 300;
  constexpr Index n = 7;
  const RubbedDisk rubbed;
  const double preload = GENERATE(0.03, 1e3);  // slips, sticks
  const double eta = GENERATE(150.0, 189.2);
  const TemporaryFolder folder;
  const Case input = read_case(folder.write(
      "case.toml",
      rubbed.system(folder, n, N) +
          fmt::format("[branch]\nparameter = \"P\"\nfrom = {}\nto = 1e4\neta = {}\n", preload, eta)));
  const SystemParameters& parameters = input.branches.front().problem.system;
  const problems::ForcedResponse problem(build_system(parameters));
  const continuation::Guess solution = problem.guess(eta, preload);
  const double R = std::exp(solution.unknowns(0));
  const Complex phi = hysteresis_coefficient(R, preload / rubbed.k).phi;

  const Index disk_size = 3;
  const Index size = N * (disk_size + 1);
  const double w = 2 * std::numbers::pi * eta;
  std::vector<Eigen::Triplet<Complex>> entries;
  assemble(rubbed.disk, rubbed.disk.stiffness, Complex(1, rubbed.loss), 0, N, entries);
  assemble(rubbed.disk, rubbed.disk.mass, -w * w, 0, N, entries);
  const FiniteSector ring = checked(rubbed.ring);
  assemble(ring, ring.stiffness, Complex(1, rubbed.loss), N * disk_size, N, entries);
  assemble(ring, ring.mass, -w * w, N * disk_size, N, entries);
  ComplexVector force = ComplexVector::Zero(size);
  for (Index i = 0; i < N; ++i) {
    const auto on_disk = static_cast<int>(i * disk_size);
    const auto on_ring = static_cast<int>(N * disk_size + i);
    for (const auto& [row, column, sign] : {std::tuple{on_disk, on_disk, 1.0},
                                            {on_disk, on_ring, -1.0},
                                            {on_ring, on_disk, -1.0},
                                            {on_ring, on_ring, 1.0}})
      entries.emplace_back(row, column, sign * rubbed.k * phi);
    force(i * disk_size + 1) = std::pow(forward(n, N), static_cast<double>(i));
  }
  Eigen::SparseMatrix<Complex> stiffness(size, size);
  stiffness.setFromTriplets(entries.begin(), entries.end());
  const ComplexVector whole = continuation::ComplexSparseFactors(stiffness).solve(force);

  // One sector: the disk's nodes under the load and the force k phi r of the contact.
  FiniteSector disk = rubbed.disk;
  disk.outputs = {0, 1, 2};
  SectorSolver on_disk(disk, forward(n, N), {0, rubbed.loss});
  SectorSolver on_ring(ring, forward(n, N), {0, rubbed.loss});
  const SectorResponse& base = on_disk.at(eta);
  const Complex damper = on_ring.at(eta).compliance(0, 0);
  const Complex r = -base.free(0) / (1.0 + rubbed.k * phi * (base.compliance(0, 0) + damper));
  ComplexVector one(4);
  one << base.output_free + base.output_compliance * (rubbed.k * phi * r), -damper * rubbed.k * phi * r;
  CHECK((problem.guess(eta, preload).regime == problems::ContactProblem::slip) == (preload < 1));
  CHECK_THAT(std::abs(r), WithinRel(R, 1e-10));
  Vector values;
  problem.observe(solution.unknowns, solution.parameters, solution.regime, values);
  REQUIRE(values.size() == 15);
  CHECK(problem.observables()[11].name == "Y_2");
  CHECK(problem.observables()[14].name == "U_2");
  const std::array<Index, 4> shown = {1, 2, 0, 3};  // dof 4 is the disk of the next sector
  for (Index i = 0; i < 4; ++i)
    CHECK_THAT(values(11 + i), WithinRel(std::abs(one(shown[static_cast<std::size_t>(i)])), 1e-10));
  double worst = 0;
  for (Index i = 0; i < N; ++i) {
    const Complex phase = std::pow(forward(n, N), static_cast<double>(i));
    for (Index d = 0; d < 3; ++d)
      worst = std::max(worst, std::abs(whole(i * disk_size + d) - phase * one(d)) / std::abs(one(d)));
    worst = std::max(worst, std::abs(whole(N * disk_size + i) - phase * one(3)) / std::abs(one(3)));
  }
  // The coupling of the disks, 5e7, cancels to the stiffness of a blade, 1e5, times 1/loss at a peak.
  CHECK(worst < 1e-10);
}

TEST_CASE("A study of sectors finds the optimum of the built-in model") {
  const TemporaryFolder folder;
  const StudyCase study = read_study(
      folder.write("case.toml", paper_system(folder, true, 1) +
                                    "[study]\nparameter = \"P\"\nfrom = 0.1\nto = 100.0\neta = [0.5, 6.0]\n"
                                    "for_each = { contact_stiffness = [1e5, 3.784e5] }\n"));
  REQUIRE(study.count == 2);
  const FinishedDesign finished = study_design(study, 1);
  REQUIRE(finished.result.failure.empty());
  SystemParameters parameters = figure_8(1);
  parameters.interface_stiffness = 30 * 3.784e5;
  const problems::PreloadStudy expected = problems::study_preload(parameters, study.range, study.options);
  CHECK_THAT(finished.result.optimum->peak.Y, WithinRel(expected.optimum->peak.Y, 1e-10));
  CHECK_THAT(finished.result.optimum->peak.preload, WithinRel(expected.optimum->peak.preload, 1e-8));
  CHECK_THAT(finished.result.optimum->energy, WithinRel(expected.optimum->energy, 1e-8));
  CHECK_THAT(finished.result.optimum->damping, WithinRel(expected.optimum->damping, 1e-9));
}

TEST_CASE("A study over nodal diameters of a bladed disk runs, and the program tells of its modes") {
  const TemporaryFolder folder;
  const std::string path = folder.write(
      "case.toml", RubbedDisk().system(folder, 3, 24) +
                       "[study]\nparameter = \"P\"\nfrom = 1e-3\nto = 10.0\neta = [50.0, 400.0]\n"
                       "for_each = { wave_number = [0, 3, 12] }\n");
  const Outcome outcome = arcslip_program("study '" + path + "' -o '" + folder.path("out") + "'");
  INFO(outcome.err);
  CHECK(outcome.status == 0);
  CHECK(read_csv(folder.path("out/optimum.csv")).size() == 4);
  const Outcome check = arcslip_program("check '" + path + "'");
  CHECK(check.status == 0);
  CHECK_THAT(check.out, ContainsSubstring("base: 3 of 3 modes, error"));
}

TEST_CASE("What is wrong with a sector's case is told in one line with its place") {
  const std::string good_branch = "[branch]\nparameter = \"eta\"\nfrom = 100.0\nto = 200.0\n";
  const auto mistake = GENERATE(values<Mistake>({
      {"wave_number = 3", "wave_number = 13", ":3:15", "system.wave_number", "<= sectors/2 = 12", "13"},
      {"sectors = 24", "sectors = 0", ":4:11", "system.sectors", "an integer >= 1", "0"},
      {"contact_stiffness", "elements", ":5:", "system.elements", "unknown key", "contact_stiffness"},
      {"\"base_mass.mtx\"", "\"none.mtx\"", ":9:8", "system.base.mass", "none.mtx: cannot be read",
       "No such"},
      {"\"base_mass.mtx\"", "\"base_left.txt\"", ":9:8", "system.base.mass", "expected", "base_left.txt:1"},
      {"\"base_stiffness.mtx\"", "\"damper_stiffness.mtx\"", ":8:1", "system.base", "expected 4", "2 rows"},
      {"\"base_right.txt\"", "[4, 4]", ":8:1", "system.base", "left boundary has 1", "2"},
      {"\"base_right.txt\"", "[5]", ":12:10", "system.base.right", "a dof from 1 to 4", "5"},
      {"contact = [1]", "contact = [1, 2]", ":21:11", "system.damper.contact", "2 dofs, as many", "1"},
      {"contact = [1]", "contact = []", ":13:11", "system.base.contact", "one dof or more", "none"},
      {"contact = [1]", "contact = [4]", ":8:1", "system.base", "its pair on the left", "4"},
      {"contact = [1]", "contact = [1]\ndamping_kind = \"dry\"", ":14:16", "damping_kind", "viscous", "dry"},
      {"contact = [1]", "contact = [1]\ndamping_kind = \"viscous\"", "", "reference_frequency", "", ""},
      {"\"base_load.txt\"", "{ dof = [2], value = [1.0, 2.0] }", ":15:", "value", "1 numbers", "2"},
      {"\"base_load.txt\"", "{ dof = [2], value = [0.0] }", ":15:8", "load", "not 0", ""},
      {"\"base_load.txt\"", "\"case.toml\"", ":15:8", "load", "a dof from 1 to 4",
       "a word that is no number"},
      {"damping = {", "damping = { kind = \"modal\",", ":7:", "damping.kind", "base or damper", ""},
  }));
  const TemporaryFolder folder;
  const std::string text = RubbedDisk().system(folder, 3, 24) + good_branch;
  CHECK_NOTHROW(read_case(folder.write("case.toml", text)));
  const std::string path = folder.write("case.toml", replaced(text, mistake.from, mistake.to));
  check_message(error_of([&] { read_case(path); }), mistake);
}

TEST_CASE("Proportional and modal damping of sectors act as their closed forms say") {
  const RubbedDisk rubbed;
  const TemporaryFolder folder;
  const SparseMatrix c = 3.0 * rubbed.disk.mass + 2e-6 * rubbed.disk.stiffness;
  folder.write("c.mtx", write_matrix_market(c, MatrixSymmetry::symmetric));
  const std::string text =
      rubbed.system(folder, 3, 24) + "[branch]\nparameter = \"eta\"\nfrom = 100\nto = 300\n";
  const auto system = [&](const std::string& more, const std::string& damping) {
    const std::string with = replaced(text, "output = [2, 3, 4]", more);
    const std::string damped = replaced(with, "damping = { base = 1e-3, damper = 1e-3 }", damping);
    return build_system(read_case(folder.write("case.toml", damped)).branches.front().problem.system);
  };
  const FrictionSystem plain = system("", "damping = { base = 1e-3 }");
  const auto check = [&](const FrictionSystem& damped,
                         double imaginary) {  // Im d of the first mode at eta = 200
    const double frequency = damped.base.modes()[0].frequency;
    CHECK(frequency == plain.base.modes()[0].frequency);
    CHECK_THAT(damped.base.loss().part(200, frequency), WithinRel(imaginary, 1e-9));
  };
  const double f = plain.base.modes()[0].frequency;
  const double pi = std::numbers::pi;
  check(plain, 2e-3 * f * f);
  check(system("damping_kind = \"viscous\"\nreference_frequency = 50", "damping = { base = 1e-3 }"),
        2e-3 * 200 / 50 * f * f);
  check(system("damping_kind = \"modal\"", "damping = { base = 1e-3 }"), 2e-3 * f * 200);
  // j w (alpha M + beta K)/(2 pi)^2 in the mode: w alpha/(2 pi)^2 + w beta f^2.
  check(system("damping = \"c.mtx\"", ""), 200 * 3 / (2 * pi) + 2 * pi * 200 * 2e-6 * f * f);
  check(system("mass_factor = 3.0", ""), 200 * 3 / (2 * pi));
  check(system("mass_factor = 3.0", "damping = { base = 1e-3 }"), 200 * 3 / (2 * pi) + 2e-3 * f * f);
}

TEST_CASE("A damping matrix that modes do not diagonalise is refused, and where a window is unknown") {
  const TemporaryFolder folder;
  const RubbedDisk rubbed;
  SparseMatrix c = rubbed.disk.stiffness;
  c.coeffRef(1, 1) *= 2;
  folder.write("c.mtx", write_matrix_market(c, MatrixSymmetry::symmetric));
  const std::string text =
      rubbed.system(folder, 3, 24) + "[branch]\nparameter = \"eta\"\nfrom = 100\nto = 300\n";
  const std::string path =
      folder.write("case.toml", replaced(text, "output = [2, 3, 4]", "damping = \"c.mtx\""));
  CHECK_THAT(error_of([&] { read_case(path); }),
             ContainsSubstring(
                 "system.base.damping: the damping matrix is not a sum alpha M + beta K, which the modes of "
                 "the sector need; path = \"full\" in [system] takes any"));
  const std::string cycle = folder.write(
      "cycle.toml", rubbed.system(folder, 3, 24) +
                        "[branch]\nresponse = \"limit_cycle\"\nparameter = \"P\"\nfrom = 1\nto = 2\n");
  CHECK_THAT(error_of([&] { read_case(cycle); }), ContainsSubstring("system.reduction_window"));
}
