// Outputs that are linear combinations of dofs: against the motions of the dofs themselves, sampled in time.

#include <fmt/format.h>

#include <cmath>
#include <string>
#include <utility>

#include "arcslip/motion/swing.hpp"
#include "arcslip/problems/response/harmonic_response.hpp"
#include "case_runs.hpp"
#include "case_texts.hpp"
#include "small_structures.hpp"

using namespace arcslip;
using namespace arcslip::testing;
using problems::HarmonicResponse;

namespace {

/// A chain that rubs at its first two dofs and meets a stop at the third, with these further lines of its
/// base.
SmallStructure chain_of(RandomSystems& draw) {
  SmallStructure s = random_structure(draw);
  s.contact_stiffness = {draw.uniform(0.2, 1), draw.uniform(0.2, 1), 0};
  s.preload = 0.2;
  return s;
}

/// Its case file with these further lines of its base; of several harmonics it meets a stop at the third dof.
std::string chain_text(const SmallStructure& s, const std::string& harmonics, const std::string& more,
                       const std::string& branch = "") {
  std::string text = small_system_text(s, harmonics) + more;
  if (harmonics != "1")
    text +=
        "\n[[element]]\nkind = \"unilateral\"\nname = \"stop\"\nat = \"base\"\ncontact = 3\n"
        "closes = \"forwards\"\nstiffness = 0.4\ngap = 0.1\n";
  return text + "\n[branch]\nparameter = \"eta\"\nfrom = 0.1\nto = 0.3\n" + branch;
}

const std::string three_weights =
    "output = [2]\nweights = { one = { dof = [2], value = [1.0] }, strain = { dof = [1, 2, 3], value = [0.7, "
    "-1.3, 2.1] }, none = { dof = [1, 3], value = [0.0, 0.0] } }\n";

/// The first branch of a case.
TracedBranch traced_on(const std::string& path) {
  return std::move(trace(read_case(path).branches[0]).front());
}

/// The chain of a seed in three harmonics, by modes and on the full path.
std::pair<TracedBranch, TracedBranch> on_both_paths(std::uint64_t seed, const std::string& branch) {
  RandomSystems draw(seed);
  const TemporaryFolder folder;
  const SmallStructure s = chain_of(draw);
  write_matrices(s, folder);
  const std::string text = chain_text(s, "3", three_weights, branch);
  const std::string full = replaced(text, "model = \"sector\"\n", "model = \"sector\"\npath = \"full\"\n");
  return {traced_on(folder.write("reduced.toml", text)), traced_on(folder.write("full.toml", full))};
}

}  // namespace

TEST_CASE("Weights give the sum of dofs, in every harmonic and as greatest value in time") {
  RandomSystems draw(71);
  for (int i = 0; i < 3; ++i) {
    const TemporaryFolder folder;
    const SmallStructure s = chain_of(draw);
    write_matrices(s, folder);
    const TracedBranch traced = traced_on(folder.write("case.toml", chain_text(s, "5", three_weights)));
    const auto& problem = dynamic_cast<const HarmonicResponse&>(traced.problem());
    const ComplexMatrix turns = turns_of(problem.system().orders, 1 << 16);
    double worst = 0;
    for (std::size_t k = 0; k < traced.branch.points.size(); k += 15) {
      const BranchPoint& point = traced.branch.points[k];
      const auto told = [&](const std::string& name) { return value(traced, point, name); };
      for (const char* of : {"", "_peak", "_h0", "_h2", "_h3", "_h5"}) {
        CHECK(told(std::string("Y_one") + of) == told(std::string("Y_2") + of));
        CHECK(told(std::string("Y_none") + of) == 0);
      }
      const HarmonicVector strain =
          -(0.7 * problem.motion(point.unknowns, 0) - 1.3 * problem.motion(point.unknowns, 1) +
            2.1 * problem.motion(point.unknowns, 2));
      const double size = strain.norm();
      worst = std::max(worst, std::abs(told("Y_strain") - std::abs(strain(0))) / size);
      worst = std::max(worst, std::abs(told("Y_strain_h0") - strain(1).real()) / size);
      worst = std::max(worst, std::abs(told("Y_strain_h3") - std::abs(strain(3))) / size);
      const double sampled = (turns * strain).real().cwiseAbs().maxCoeff();
      CHECK(told("Y_strain_peak") >= sampled * (1 - 1e-8));
      CHECK_THAT(told("Y_strain_peak"), WithinRel(sampled, 1e-7));  // 25 (2 pi/2^16)^2/8 between samples
    }
    CHECK(worst < 1e-9);  // both are solved to 1e-10
  }
}

TEST_CASE("Outputs by weights have exact gradients") {
  RandomSystems draw(72);
  for (const char* harmonics : {"1", "3", "5"}) {
    const TemporaryFolder folder;
    const SmallStructure s = chain_of(draw);
    write_matrices(s, folder);
    const TracedBranch traced = traced_on(
        folder.write("case.toml", chain_text(s, harmonics,
                                             "weights = { strain = { dof = [1, 2, 3], value = [0.7, "
                                             "-1.3, 2.1] } }\n")));
    check_derivatives_along(traced, 7, 40);
  }
}

TEST_CASE("A file of weights gives an output for each row") {
  RandomSystems draw(73);
  const TemporaryFolder folder;
  const SmallStructure s = chain_of(draw);
  write_matrices(s, folder);
  folder.write("w.csv", "# dofs 1 to 3\nstrain, 0.7, -1.3, 2.1\n\n0,1e0,0 # the second\r\n");
  const std::string inline_text = chain_text(s, "3", three_weights);
  const std::string file_text = chain_text(s, "3", "output = [2]\nweights = \"w.csv\"\n");
  const TracedBranch given = traced_on(folder.write("inline.toml", inline_text));
  const TracedBranch read = traced_on(folder.write("file.toml", file_text));
  REQUIRE(read.branch.points.size() == given.branch.points.size());
  for (std::size_t k = 0; k < read.branch.points.size(); k += 11) {
    const BranchPoint& a = read.branch.points[k];
    const BranchPoint& b = given.branch.points[k];
    CHECK_THAT(value(read, a, "Y_strain_peak"), WithinRel(value(given, b, "Y_strain_peak"), 1e-12));
    CHECK(value(read, a, "Y_w2") == value(read, a, "Y_2"));
  }
}

TEST_CASE("The resolved case has the weights that a file held") {
  const TemporaryFolder folder;
  folder.write("w.csv", "sum, 1.0, 0, 2.5\n");
  const Case input = read_case(folder.write("case.toml",
                                            "[system]\nmodel = \"spring_mass\"\ncontact_stiffness = "
                                            "1.0\npreload = 1.0\nbase = { mass = [1.0, 1.0, 1.0], "
                                            "stiffness = [1.0, 1.0, 1.0], weights = \"w.csv\" "
                                            "}\n[branch]\nparameter = \"eta\"\nfrom = 0.5\nto = 2.0\n"));
  const auto expected = nlohmann::ordered_json::parse(R"({"sum": {"dof": [1, 3], "value": [1.0, 2.5]}})");
  CHECK(input.resolved["system"]["base"]["weights"] == expected);
}

TEST_CASE("Peaks of an output in time are where a branch close by is lower on both sides") {
  RandomSystems draw(74);
  const TemporaryFolder folder;
  const SmallStructure s = chain_of(draw);
  write_matrices(s, folder);
  const std::string wanted = "extrema_of = [\"Y_strain_peak\"]\n";
  const TracedBranch traced = traced_on(folder.write("case.toml", chain_text(s, "3", three_weights, wanted)));
  double highest = 0;
  for (const BranchPoint& point : traced.branch.points)
    highest = std::max(highest, value(traced, point, "Y_strain_peak"));
  const std::vector<BranchPoint> peaks = points(traced, PointType::peak);
  REQUIRE(!peaks.empty());
  double found = 0;
  for (const BranchPoint& peak : peaks) {
    const double here = value(traced, peak, "Y_strain_peak");
    found = std::max(found, here);
    for (const double side : {-1.0, 1.0}) {
      continuation::Guess near{peak.unknowns, peak.parameters, peak.regime};
      near.parameters(0) *= 1 + side * 1e-4;
      const auto& problem = dynamic_cast<const HarmonicResponse&>(traced.problem());
      const continuation::Guess beside = problem.guess(near.parameters(0), near.parameters(1));
      Vector values;
      problem.observe(beside.unknowns, beside.parameters, beside.regime, values);
      const auto names = continuation::observable_names(problem);
      const Index which = continuation::index_of(names, "Y_strain_peak");
      CHECK(values(which) < here);
    }
  }
  CHECK(found == highest);
}

TEST_CASE("A greatest value that is met twice in a period has the mean of both derivatives") {
  // 1/2 + cos 2 theta, greatest at 0 and pi to the same side; a part of the first harmonic lifts one of them
  const std::vector<int> orders{1, 0, 2};
  const auto at = [&](Complex first) {
    HarmonicVector x(3);
    x << first, 0.5, 1.0;
    return farthest_of(orders, x);
  };
  CHECK(at(0).value == 1.5);
  CHECK(std::abs(at(0).by(0)) < 1e-14);
  CHECK(std::abs(at(0).by(1) - 1.0) < 1e-14);
  CHECK(std::abs(at(0).by(2) - 1.0) < 1e-14);
  for (const double side : {1.0, -1.0}) {
    const Farthest beside = at(1e-6 * side);
    CHECK_THAT(beside.value, WithinAbs(1.5 + 1e-6, 1e-12));
    CHECK(std::abs(beside.by(0) - side) < 1e-5);
  }
  // as far to both sides
  HarmonicVector odd(2);
  odd << 1.0, 0.1;
  const Farthest both = farthest_of(std::vector{1, 3}, odd);
  CHECK_THAT(both.value, WithinAbs(1.1, 1e-14));
  CHECK(std::abs(both.by(0) - 1.0) + std::abs(both.by(1) - 1.0) < 1e-14);
}

TEST_CASE("Wrong weights are refused by one line") {
  const auto mistake = GENERATE(values<std::pair<std::string, std::string>>({
      {"weights = { a = { dof = [4], value = [1.0] } }", "that is a dof from 1 to 3"},
      {"weights = { a = { dof = [1, 2], value = [1.0] } }", "expected 2 numbers, as many as dofs, got 1"},
      {"weights = { a = { dof = [1], value = [nan] } }", "system.base.weights.a.value"},
      {"weights = { a = { dof = [], value = [] } }", "expected one dof or more, got none"},
      {"weights = { peak = { dof = [1], value = [1.0] } }", "names of letters"},
      {"weights = { b_h3 = { dof = [1], value = [1.0] } }", "names of letters"},
      {"weights = {}", "expected one output or more"},
      {"weights = 3", "a file of weights, or a table"},
      {"weights = \"none.csv\"", "none.csv"},
      {"weights = \"few.csv\"", "few.csv:1: expected 3 weights, one for each dof, got 2"},
      {"weights = \"inf.csv\"", "inf.csv:2: expected a finite number as weight of dof 2, got inf"},
      {"weights = \"twice.csv\"", "expected names that differ, got \"a\" twice"},
      {"weights = \"empty.csv\"", "expected rows of weights, got none"},
  }));
  RandomSystems draw(75);
  const TemporaryFolder folder;
  const SmallStructure s = chain_of(draw);
  write_matrices(s, folder);
  folder.write("few.csv", "a, 1, 2\n");
  folder.write("inf.csv", "a, 1, 2, 3\nb, 1, inf, 2\n");
  folder.write("twice.csv", "a, 1, 2, 3\na, 1, 2, 2\n");
  folder.write("empty.csv", "# nothing\n");
  const std::string path = folder.write("case.toml", chain_text(s, "3", mistake.first + "\n"));
  const std::string message = error_of([&] { read_case(path); });
  CHECK_THAT(message, ContainsSubstring(mistake.second) && ContainsSubstring("weights"));
  CHECK(message.find('\n') == message.npos);
}

TEST_CASE("Outputs of the full path have exact gradients, and peaks by them") {
  const auto [one, other] = on_both_paths(78, "extrema_of = [\"Y_strain_peak\", \"Y_2\"]\n");
  check_derivatives_along(other, 7, 60);
  const std::vector<BranchPoint> peaks = points(one, PointType::peak);
  const std::vector<BranchPoint> same = points(other, PointType::peak);
  REQUIRE(!peaks.empty());
  REQUIRE(same.size() == peaks.size());
  for (std::size_t i = 0; i < peaks.size(); ++i)
    CHECK_THAT(same[i].parameters(0), WithinRel(peaks[i].parameters(0), 1e-7));
}

TEST_CASE("Weights act alike on the reduced and the full path") {
  const auto [one, other] = on_both_paths(76, "\n[continuation]\nstop_at = [0.2]\n");
  for (const char* name : {"Y_strain", "Y_strain_h3", "Y_strain_peak", "Y_one_peak"})
    CHECK_THAT(value(one, points(one, PointType::user).front(), name),
               WithinRel(value(other, points(other, PointType::user).front(), name), 1e-8));
}
