// The section [ring] of case files: what it makes of a sector, and what it refuses.

#include <Eigen/LU>
#include <numeric>

#include "arcslip/assembly/reduced_pair.hpp"
#include "arcslip/assembly/whole_ring.hpp"
#include "arcslip/problems/response/sector_motions.hpp"
#include "arcslip/problems/tasks/verification.hpp"
#include "case_runs.hpp"
#include "cases/ring_numbers.hpp"
#include "catch.hpp"
#include "mistakes.hpp"
#include "program.hpp"
#include "results/sector_table.hpp"
#include "temporary_folder.hpp"
#include "whole_rings.hpp"

using namespace arcslip;
using namespace arcslip::testing;
using problems::HarmonicResponse;
using problems::SectorMotions;

namespace {

std::string ring_case(const std::string& model, const std::string& ring) {
  return "[system]\nmodel = \"" + model +
         "\"\nwave_number = 2\nelements = 8\nmass_ratio = 5.0\nfrequency_ratio = 4.0\n"
         "interface_stiffness = 500.0\nforce = 1.0\npreload = 1.0\ndamping = { base = 1e-2, damper = 2e-2 "
         "}\n" +
         ring + "[branch]\nparameter = \"eta\"\nfrom = 3.0\nto = 5.0\n";
}

SystemParameters system_of(const std::string& text) {
  const TemporaryFolder folder;
  return read_case(folder.write("case.toml", text)).branches.front().problem.system;
}

/// Z(eta) of a ring of such elements, each with a factor on its stiffness or, where that is 0, missing.
ComplexMatrix assembled(const ChainElement& element, const Vector& factors, const Loss& loss, double eta) {
  const Index n = factors.size();
  const Index dofs = element.mass.rows() / 2;
  ComplexMatrix z = ComplexMatrix::Zero(n * dofs, n * dofs);
  const double w = two_pi * eta;
  for (Index e = 0; e < n; ++e) {
    for (Index i = 0; i < 2 * dofs; ++i) {
      for (Index k = 0; k < 2 * dofs; ++k) {
        const Index row = (e * dofs + i) % (n * dofs);
        const Index column = (e * dofs + k) % (n * dofs);
        z(row, column) +=
            factors(e) * Complex(1, loss.at(eta)) * static_cast<double>(element.stiffness(i, k));
        if (factors(e) != 0) z(row, column) -= w * w * static_cast<double>(element.mass(i, k));
      }
    }
  }
  return z;
}

}  // namespace

TEST_CASE("Split and mistuned rods and beams are what their assembled elements are", "[ring section]") {
  const std::string model = GENERATE("rods", "beams");
  const SystemParameters system = system_of(
      ring_case(model,
                "[ring]\nsplit = [8, 3]\nload = \"travelling\"\n[[ring.mistuning]]\npart = \"base\"\n"
                "factors = [1, 1.1, 0.9, 1.02, 1, 0.97, 1.05, 1]\n[[ring.mistuning]]\npart = \"base\"\n"
                "dofs = [1]\nmass = 0.5\nfactors = [1, 1.4, 1, 1, 0.8, 1, 1, 1]\n"));
  const auto make = system.model == StructureModel::rods ? rod_element : beam_element;
  const ChainElement base = make(5, 80, 2, 8);
  const ChainElement damper = make(1, 1, 2, 8);
  const Index dofs = base.mass.rows() / 2;
  Vector stiffness(8);
  stiffness << 1, 1.1, 0.9, 1.02, 1, 0.97, 1.05, 1;
  Vector links = Vector::Ones(8);
  links(2) = links(7) = 0;
  const PairLosses losses = structures_of(system).losses(system);
  const PreciseComplexVector load = reduce(system).base.load;
  const HarmonicResponse problem = response_of(system);
  for (const double eta : {3.3, 4.2}) {
    ComplexMatrix z = ComplexMatrix::Zero(16 * dofs, 16 * dofs);
    z.topLeftCorner(8 * dofs, 8 * dofs) = assembled(base, stiffness, losses.base(system), eta);
    z.bottomRightCorner(8 * dofs, 8 * dofs) = assembled(damper, links, losses.damper(system), eta);
    z(dofs, dofs) -= std::pow(two_pi * eta, 2) * .5 * .4;
    z(4 * dofs, 4 * dofs) += std::pow(two_pi * eta, 2) * .5 * .2;
    ComplexVector force = ComplexVector::Zero(16 * dofs);
    for (Index i = 0; i < 8; ++i) {
      const Index y = i * dofs;
      const Index u = (8 + i) * dofs;
      const double k = 500.0 / 8;
      z(y, y) += k;
      z(u, u) += k;
      z(y, u) -= k;
      z(u, y) -= k;
      for (Index j = 0; j < dofs; ++j)
        force(y + j) =
            static_cast<Complex>(load(j)) * std::polar(1.0, -two_pi * 2 * static_cast<double>(i) / 8);
    }
    const ComplexVector d = z.partialPivLu().solve(force);
    const SectorMotions found = problems::sector_motions(problem, problem.guess(eta, 1e9));
    for (Index i = 0; i < 8; ++i) {
      CHECK(std::abs(found.base(0, i) - d(i * dofs)) < 1e-10 * d.norm());
      CHECK(std::abs(found.damper(0, i) - d((8 + i) * dofs)) < 1e-10 * d.norm());
    }
  }
}

TEST_CASE("A node of the damper keeps an element on one side at least", "[ring section]") {
  for (const char* split : {"[1, 2]", "[8, 1]", "[4, 2, 5]"}) {
    INFO(split);
    CHECK_THROWS_WITH(system_of(ring_case("rods", fmt::format("[ring]\nsplit = {}\n", split))),
                      ContainsSubstring("ring.split") && ContainsSubstring("expected no neighbours"));
  }
}

TEST_CASE("A link takes no more from a ring than there is", "[ring section]") {
  const TemporaryFolder folder;
  const std::string header = "%%MatrixMarket matrix coordinate real symmetric\n";
  folder.write("k.mtx", header + "2 2 3\n1 1 1.3\n2 1 -0.3\n2 2 0.3\n");
  folder.write("m.mtx", header + "2 2 1\n1 1 1\n");
  const auto read = [&](const std::string& changed) {
    read_case(
        folder.write("case.toml",
                     "[system]\nmodel = \"sector\"\nsectors = 4\nwave_number = 1\ncontact_stiffness = 0.5\n"
                     "preload = 0.5\ndamping = { base = 1e-2 }\n[system.base]\nmass = \"m.mtx\"\n"
                     "stiffness = \"k.mtx\"\nleft = [1]\nright = [2]\ncontact = [1]\n"
                     "load = { dof = [1], value = [1.0] }\n[ring]\n" +
                         changed + "[branch]\nparameter = \"eta\"\nfrom = 0.05\nto = 0.5\n"));
  };
  const std::string cut = "[[ring.cut]]\npart = \"base\"\nafter = [2]\ndofs = [1, 1]\nstiffness = ";
  // Springs of 1 to ground, links of 0.3: the ring gives way where the link alone is as soft as all else.
  Matrix ring = Matrix::Identity(4, 4);
  for (Index i = 0; i < 4; ++i) {
    const Index next = (i + 1) % 4;
    const Vector stretch = Vector::Unit(4, next) - Vector::Unit(4, i);
    ring += 0.3 * stretch * stretch.transpose();
  }
  const Vector stretch = Vector::Unit(4, 2) - Vector::Unit(4, 1);
  const double most = 1 / stretch.dot(ring.partialPivLu().solve(stretch));
  CHECK_NOTHROW(read(cut + "0.3\n"));
  CHECK_NOTHROW(read(cut + fmt::format("{}\n", most * (1 - 1e-5))));
  const auto none =
      ContainsSubstring("ring: mistuning and cuts leave a part of the ring less than no stiffness");
  CHECK_THROWS_WITH(read(cut + fmt::format("{}\n", most * (1 + 1e-5))), none);
  CHECK_THROWS_WITH(read(cut + "5\n"), none);
  const std::string mistuned = "[[ring.mistuning]]\npart = \"base\"\ndofs = [1]\nfactors = [1, 0.1, 1, 1]\n";
  CHECK_NOTHROW(read(mistuned + "stiffness = 0.5\nmass = 0.5\n"));
  CHECK_THROWS_WITH(read(mistuned + "stiffness = 5\n"), none);
  CHECK_THROWS_WITH(read(mistuned + "mass = 1.2\n"), ContainsSubstring("without mass"));
}

TEST_CASE("A point load on a ring that is its own mirror image moves both sides alike", "[ring section]") {
  // of beams, whose rotations the wave N/2 would load if it ran one way
  const SystemParameters system =
      system_of(ring_case("beams",
                          "[ring]\nload = \"point\"\n[[ring.mistuning]]\npart = \"base\"\n"
                          "factors = [1.2, 0.8, 1.1, 0.9, 0.9, 1.1, 0.8, 1.2]\n"));
  const HarmonicResponse problem = response_of(system);
  for (const double eta : {1.2, 3.3, 4.2}) {
    const SectorMotions found = problems::sector_motions(problem, problem.guess(eta, 1e9));
    for (Index i = 1; i < 4; ++i)
      CHECK(std::abs(found.base(0, i) - found.base(0, 8 - i)) < 1e-9 * std::abs(found.base(0, i)));
  }
}

TEST_CASE("Factors of contacts are read from lists, files and scatter", "[ring section]") {
  const TemporaryFolder folder;
  folder.write("factors.csv", "1.5 # first\n2\n1,1,1\n1\n1\n0.5\n");
  const std::string path = folder.write(
      "case.toml", ring_case("rods",
                             "[ring]\npreload = \"factors.csv\"\nfriction = [1, 1, 1, 1, 1, 1, 1, 3]\n"
                             "stiffness = { scatter = 0.1, seed = 4 }\nmissing = [3]\n"));
  const SystemParameters system = read_case(path).branches.front().problem.system;
  const double k = 500.0 / 8;
  const double limit = 80;  // of the force over P: K*/N times N
  REQUIRE(system.contacts.size() == 8);
  const auto limit_of = [&](std::size_t i) {
    return system.contacts[i].stiffness * system.contacts[i].slip_per_preload * 8 / limit;
  };
  CHECK_THAT(limit_of(0), WithinRel(1.5, 1e-14));
  CHECK_THAT(limit_of(1), WithinRel(2.0, 1e-14));
  CHECK_THAT(limit_of(7), WithinRel(1.5, 1e-14));
  CHECK(system.contacts[2].stiffness == 0);
  CHECK(system.contacts[0].stiffness / k != 1);
}

TEST_CASE("Scattered numbers are the same everywhere, and correlated as they are said to be",
          "[ring section][numbers]") {
  const std::vector<double> few = scattered(3, 1, 0);
  CHECK_THAT(few[0], WithinRel(scattered(3, 1, 0)[0], 1e-15));
  constexpr Index n = 40000;
  const std::vector<double> all = scattered(n, 7, 3);
  const auto correlation = [&](Index distance) {
    double sum = 0;
    for (Index i = 0; i < n; ++i)
      sum += all[static_cast<std::size_t>(i)] * all[static_cast<std::size_t>((i + distance) % n)];
    return sum / static_cast<double>(n);
  };
  CHECK(std::abs(std::accumulate(all.begin(), all.end(), 0.0)) < .05 * static_cast<double>(n));
  for (const Index distance : {0, 2, 5, 20}) {
    const double expected = std::exp(-std::pow(static_cast<double>(distance) / 3, 2) / 2);
    CHECK(std::abs(correlation(distance) - expected) < .05);
  }
}

TEST_CASE("A table of all sectors has what each contact does at special points", "[ring section]") {
  const TemporaryFolder folder;
  const Case input = read_case(folder.write(
      "case.toml", ring_case("rods", "[ring]\nload = \"standing\"\n") + "extrema_of = [\"Y_max\"]\n"));
  const std::vector<TracedBranch> traced = trace(input.branches.front());
  REQUIRE(traced.size() == 1);
  CHECK(traced.front().branch.complete());
  const std::string text = sectors_header(traced.front()) + sector_rows(0, traced.front());
  const auto rows = read_csv(folder.write("sectors.csv", text));
  const auto special =
      std::count_if(traced.front().branch.points.begin(), traced.front().branch.points.end(),
                    [](const auto& point) { return point.type != continuation::PointType::regular; });
  CHECK(std::ssize(rows) == 1 + 8 * special);
  CHECK(rows.front().back() == "psi");
  CHECK_THAT(error_of([&] { return describe(input.branches.front().values); }),
             ContainsSubstring("no error"));
}

TEST_CASE("What no whole ring has is refused on one line", "[ring section]") {
  const std::string ring =
      "[ring]\nload = \"standing\"\npreload = [1, 1, 1, 1, 1, 1, 1, 1]\nsplit = [8]\n[[ring.mistuning]]\n"
      "part = \"base\"\ndofs = [1]\nmass = 0.1\nfactors = [1, 1, 1, 1, 1, 1, 1, 1.5]\n";
  const std::string right = ring_case("rods", ring);
  const TemporaryFolder folder;
  REQUIRE_NOTHROW(read_case(folder.write("case.toml", right)));
  for (const Mistake& mistake : std::vector<Mistake>{
           {"load = \"standing\"", "load = \"stand\"", ":12:", "ring.load", "\"travelling\", \"standing\"",
            "stand"},
           {"load = \"standing\"", "load = [1, 2]", ":12:", "ring.load", "8 amplitudes", "got 2"},
           {"preload = [1, ", "preload = [", ":13:", "ring.preload", "8 numbers", "got 7"},
           {"preload = [1, ", "preload = [0, ", ":13:", "ring.preload", "> 0", "0"},
           {"preload = [1, 1, 1, 1, 1, 1, 1, 1]", "preload = { scatter = 9, law = \"normal\" }",
            ":13:", "scatter", "above 0", "got"},
           {"preload = [1, 1, 1, 1, 1, 1, 1, 1]", "preload = { scater = 9 }", ":13:", "scater", "scatter",
            ""},
           {"split = [8]", "split = [9]", ":14:", "ring.split", "from 1 to 8", "9"},
           {"split = [8]", "split = [8, 8]", ":14:", "ring.split", "differ", "8 twice"},
           {"split = [8]", "splitt = [8]", ":14:", "ring.splitt", "split", ""},
           {"dofs = [1]", "dofs = [2]", ":17:", "dofs", "from 1 to 1", "2"},
           {"part = \"base\"", "part = \"bas\"", ":16:", "part", "\"base\" or \"damper\"", "bas"},
           {"mass = 0.1", "mas = 0.1", ":18:", "mas", "mass", ""},
           {"load = \"standing\"", "load = \"standing\"\namplification = 1", ":13:", "ring.amplification",
            "true or false", "1"},
           {ring + "[branch]\nparameter = \"eta\"\nfrom = 3.0",
            replaced(ring, "[ring]", "[ring]\namplification = true") +
                "[branch]\nparameter = \"P\"\neta = 4.0\nfrom = 3.0",
            "", "branch.parameter", "amplification of [ring]", ""},
           {"parameter = \"eta\"\nfrom = 3.0\nto = 5.0",
            "parameter = \"zeta_B\"\neta = 4.0\nfrom = 0.01\nto = 0.02", "", "branch.parameter", "F, K_FD",
            "zeta_B"}}) {
    check_message(
        error_of([&] { read_case(folder.write("case.toml", replaced(right, mistake.from, mistake.to))); }),
        mistake);
  }
}

TEST_CASE("The case of a split ring has the highest amplitudes that it says", "[ring section]") {
  const Run run("split_ring");
  REQUIRE(run.traced.size() == 3);
  const double expected[] = {.0933297, .0081215, .0119743};
  for (std::size_t i = 0; i < 3; ++i) {
    double highest = 0;
    for (const BranchPoint& point : points(run.traced[i], PointType::peak))
      highest = std::max(highest, value(run.traced[i], point, "Y_max"));
    CHECK_THAT(highest, WithinRel(expected[i], 1e-5));
  }
}

TEST_CASE("The amplification is over the highest amplitude of the equal ring", "[ring section]") {
  const TemporaryFolder folder;
  const auto run = [&](const std::string& ring) {
    const Case input = read_case(folder.write(
        "case.toml", ring_case("rods", "[ring]\nload = \"point\"\n" + ring) + "extrema_of = [\"Y_max\"]\n"));
    return trace(input.branches.front());
  };
  const auto highest = [](const std::vector<TracedBranch>& traced, const std::string& name) {
    double most = 0;
    for (const BranchPoint& point : traced.front().branch.points)
      most = std::max(most, value(traced.front(), point, name));
    return most;
  };
  const double equal = highest(run(""), "Y_max");
  const std::string uneven = "preload = { scatter = 0.3, seed = 2 }\nmissing = [5]\n";
  const std::vector<TracedBranch> traced = run(uneven + "amplification = true\n");
  const double own = highest(run(uneven), "Y_max");
  CHECK(own != equal);
  CHECK_THAT(highest(traced, "amplification"), WithinRel(own / equal, 1e-10));
  CHECK_THAT(highest(run("amplification = true\n"), "amplification"), WithinRel(1.0, 1e-12));
}

TEST_CASE("The case of an unevenly pressed ring's stability has the points that it says", "[ring section]") {
  const Run run("uneven_stability");
  REQUIRE(run.traced.size() == 1);
  const auto etas = [&](PointType type) {
    std::vector<double> all;
    for (const BranchPoint& point : points(run.traced[0], type)) all.push_back(point.parameters(0));
    return all;
  };
  REQUIRE(etas(PointType::neimark_sacker).size() == 1);
  CHECK_THAT(etas(PointType::neimark_sacker)[0], WithinRel(1.6847, 1e-4));
  const std::vector<double> broken = etas(PointType::symmetry_breaking);
  REQUIRE(broken.size() == 4);
  CHECK_THAT(broken.front(), WithinRel(1.7432, 1e-4));
  CHECK_THAT(broken.back(), WithinRel(1.7766, 1e-4));
  // All contacts in time say the same where the harmonics left out do not decide.
  const TracedBranch& traced = run.traced[0];
  std::size_t held = 0;
  for (const problems::Verification& point : problems::verify(
           traced.request->problem.system, traced.base.harmonics, traced.branch, {.samples = 0})) {
    const BranchPoint& at = traced.branch.points[point.point];
    CAPTURE(at.parameters(0), at.type_name(), point.growth);
    const double stable = value(traced, at, "stable");
    const double error = value(traced, at, "growth_error");
    CHECK(std::abs(point.Y_time / value(traced, at, "Y") - 1) < 0.02);
    CHECK(std::abs(point.growth - value(traced, at, "growth")) < 3 * error + 1e-3);
    if (!std::isnan(stable)) CHECK((point.growth <= 1) == (stable == 1));
    ++held;
  }
  CHECK(held > 4);
}
