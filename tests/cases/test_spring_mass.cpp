#include <Eigen/LU>
#include <cmath>
#include <numbers>

#include "arcslip/cases/study_case.hpp"
#include "arcslip/problems/response/floquet_response.hpp"
#include "arcslip/problems/ridges/preload_study.hpp"
#include "case_runs.hpp"
#include "catch.hpp"
#include "mistakes.hpp"
#include "temporary_folder.hpp"

using namespace arcslip;
using namespace arcslip::testing;

namespace {

const std::string one_mass =
    "[system]\nmodel = \"spring_mass\"\nbase = { mass = [2.0], stiffness = [3.0] }\n"
    "contact_stiffness = 1.5\nlimit_per_preload = 0.8\npreload = 0.5\nforce = 1.2\n"
    "damping = { base = 0.02, damper = 0.03 }\n";
const std::string mass_over_eta = "[branch]\nparameter = \"eta\"\nfrom = 0.2\nto = 4.0\n";

/// The branches of a case.
std::vector<TracedBranch> traced_masses(const std::string& text) {
  const TemporaryFolder folder;
  const Case input = read_case(folder.write("case.toml", text));
  std::vector<TracedBranch> all;
  for (const CaseBranch& branch : input.branches) {
    for (TracedBranch& one : trace(branch)) all.push_back(std::move(one));
  }
  return all;
}

/// Force of a spring k with a slider over its amplitude, in the first harmonic: Caughey's loop.
Complex caughey(double k, double threshold, double amplitude) {
  if (amplitude <= threshold) return k;
  const double angle = std::acos(1 - 2 * threshold / amplitude);
  return k / std::numbers::pi * Complex(angle - std::sin(2 * angle) / 2, std::pow(std::sin(angle), 2));
}

}  // namespace

TEST_CASE("A mass on a spring and a slider to ground has the response of Caughey's loop", "[structures]") {
  const double share = GENERATE(0.05, 0.5, 1.0, 1e3);  // of the preload
  const auto branches =
      traced_masses(replaced(one_mass, "preload = 0.5", fmt::format("preload = {}", share)) + mass_over_eta);
  REQUIRE(branches.size() == 1);
  const TracedBranch& branch = branches.front();
  CHECK(branch.branch.complete());
  REQUIRE(branch.branch.points.size() > 30);
  for (const continuation::BranchPoint& point : branch.branch.points) {
    const double eta = value(branch, point, "eta");
    const double R = value(branch, point, "R");
    const Complex spring = caughey(1.5, share * 0.8 / 1.5, R);
    const Complex force = (3 - 2 * eta * eta + Complex(0, 2 * 0.02 * std::sqrt(3 * 2.0) * eta) + spring) * R;
    INFO("eta = " << eta << ", R = " << R);
    CHECK_THAT(std::abs(force), WithinRel(1.2, 1e-9));
    CHECK_THAT(value(branch, point, "Y"), WithinRel(R, 1e-12));
  }
}

TEST_CASE("Friction alone bounds a mass without damping", "[structures]") {
  // From 4 L P/pi > F on; the undamped resonance is a point of its own.
  const double share = GENERATE(1.3, 2.0, 5.0);
  const double resonance = std::sqrt(3 / 2.0);
  const auto branches =
      traced_masses(replaced(replaced(one_mass, "preload = 0.5", fmt::format("preload = {}", share)),
                             "base = 0.02", "base = 0") +
                    mass_over_eta + fmt::format("[continuation]\nstop_at = [{:.17g}]\n", resonance));
  REQUIRE(branches.size() == 1);
  const TracedBranch& branch = branches.front();
  CHECK(branch.branch.complete());
  bool is_met = false;
  for (const continuation::BranchPoint& point : branch.branch.points) {
    const double eta = value(branch, point, "eta");
    const double R = value(branch, point, "R");
    const Complex force = (3 - 2 * eta * eta + caughey(1.5, share * 0.8 / 1.5, R)) * R;
    INFO("eta = " << eta << ", R = " << R);
    CHECK_THAT(std::abs(force), WithinRel(1.2, 1e-9));
    is_met = is_met || eta == resonance;
  }
  CHECK(is_met);
}

TEST_CASE("Chains of masses that stick to one another are one linear system", "[structures]") {
  const std::string kind = GENERATE("viscous", "structural");
  const auto branches = traced_masses(
      "[system]\nmodel = \"spring_mass\"\ncontact_stiffness = 0.7\npreload = 1e6\ndamping_kind = \"" + kind +
      "\"\nbase = { mass = [2.0, 1.0, 0.5], stiffness = [3.0, 2.0, 1.0], load = [0.5, 0.0, -1.0], "
      "contact = 2 }\ndamper = { mass = [0.3, 0.4], stiffness = [0.0, 0.6] }\n"
      "damping = { base = 0.02, damper = 0.03 }\n" +
      mass_over_eta);
  Matrix mass = Matrix::Zero(5, 5);
  mass.diagonal() << 2, 1, 0.5, 0.3, 0.4;
  Matrix base = Matrix::Zero(5, 5);
  base.topLeftCorner(3, 3) << 5, -2, 0, -2, 3, -1, 0, -1, 1;
  Matrix damper = Matrix::Zero(5, 5);
  damper.bottomRightCorner(2, 2) << 0.6, -0.6, -0.6, 0.6;
  Vector gap = Vector::Zero(5);
  gap(1) = -1;
  gap(4) = 1;
  Vector load(5);
  load << 0.5, 0, -1, 0, 0;
  REQUIRE(branches.size() == 1);
  for (const continuation::BranchPoint& point : branches.front().branch.points) {
    const double eta = value(branches.front(), point, "eta");
    const Complex loss(0, 2 * (kind == "viscous" ? eta : 1));
    const ComplexMatrix stiffness = (1.0 + 0.02 * loss) * base + (1.0 + 0.03 * loss) * damper -
                                    eta * eta * mass.cast<Complex>() + 0.7 * gap * gap.transpose();
    const ComplexVector x = stiffness.partialPivLu().solve(load.cast<Complex>());
    CHECK_THAT(value(branches.front(), point, "Y"), WithinRel(std::abs(x(1)), 1e-8));
    CHECK_THAT(value(branches.front(), point, "U"), WithinRel(std::abs(x(4)), 1e-8));
  }
}

TEST_CASE("Masses on springs run in every kind of response", "[structures]") {
  const auto last = [](const std::string& branch, const std::string& system = one_mass) {
    auto all = traced_masses(system + branch);
    REQUIRE(all.size() == 1);
    INFO(all.front().branch.explanation);
    CHECK(all.front().branch.complete());
    return std::move(all.front());
  };
  SECTION("the nonlinear mode goes from stuck to sliding") {
    const TracedBranch mode = last(
        "[branch]\nresponse = \"nonlinear_mode\"\nparameter = \"R\"\neta = 1.5\nfrom = 0.01\nto = 1e4\n");
    CHECK_THAT(value(mode, mode.branch.points.front(), "eta"), WithinRel(1.5, 1e-10));  // (3 + 1.5)/2
    CHECK_THAT(value(mode, mode.branch.points.back(), "eta"), WithinRel(std::sqrt(1.5), 1e-3));
  }
  SECTION("more harmonics, with the growth of disturbances") {
    const TracedBranch response =
        last("[branch]\nstability = true\nparameter = \"eta\"\nfrom = 0.2\nto = 4.0\n",
             replaced(one_mass, "preload = 0.5", "preload = 5.0") + "harmonics = 5\n");
    const auto& stuck = response.branch.points.front();
    const double eta = value(response, stuck, "eta");
    // Damping C = 2 zeta sqrt(k m) of the free base decays at C/(2 m) a unit of time.
    const double rate = 0.02 * std::sqrt(1.5);
    CHECK_THAT(response.base.disturbed->worst(stuck.unknowns, stuck.parameters, stuck.regime).growth,
               WithinRel(std::exp(-2 * std::numbers::pi * rate / eta), 1e-6));
  }
  SECTION("a limit cycle gains by its damping what the slider takes") {
    const TracedBranch cycle =
        last("[branch]\nresponse = \"limit_cycle\"\nparameter = \"P\"\nfrom = 0.5\nto = 5.0\n",
             replaced(one_mass, "base = 0.02", "base = -0.02"));
    for (const auto& point : cycle.branch.points) {
      const double R = value(cycle, point, "R");
      const double threshold = value(cycle, point, "P") * 0.8 / 1.5;
      const Complex spring = caughey(1.5, threshold, R);
      const double eta = value(cycle, point, "eta");
      CHECK_THAT(spring.imag(), WithinRel(2 * 0.02 * std::sqrt(6.0) * eta, 1e-7));
      CHECK_THAT(3 - 2 * eta * eta + spring.real(), WithinAbs(0, 1e-8));
    }
  }
}

TEST_CASE("The best preload of a mass is lower than its neighbours", "[structures]") {
  const TemporaryFolder folder;
  const StudyCase study = read_study(folder.write(
      "case.toml", replaced(one_mass, "preload = 0.5\n", "") +
                       "[study]\nparameter = \"P\"\nfrom = 0.01\nto = 20.0\neta = [0.2, 4.0]\n"));
  const auto found = problems::study_preload(study.design(0).system, study.range, study.options);
  REQUIRE(found.optimum);
  const auto highest = [&](double preload) {
    const auto all = traced_masses(
        replaced(one_mass, "preload = 0.5", fmt::format("preload = {:.17g}", preload)) + mass_over_eta);
    double most = 0;
    for (const auto& point : all.front().branch.points) most = std::max(most, value(all.front(), point, "Y"));
    return most;
  };
  CHECK_THAT(highest(found.optimum->peak.preload), WithinRel(found.optimum->peak.Y, 1e-9));
  CHECK(highest(0.97 * found.optimum->peak.preload) > found.optimum->peak.Y);
  CHECK(highest(1.03 * found.optimum->peak.preload) > found.optimum->peak.Y);
}

TEST_CASE("The shipped oscillator has the numbers that its file tells", "[structures]") {
  const Run run("spring_mass");
  REQUIRE(run.traced.size() == 4);
  for (const TracedBranch& one : run.traced) CHECK(one.branch.complete());
  const StudyCase study = read_study(source_folder() + "/problems/spring_mass.toml");
  const auto found = problems::study_preload(study.design(0).system, study.range, study.options);
  REQUIRE(found.optimum);
  CHECK_THAT(found.optimum->peak.preload, WithinRel(1.3896, 1e-4));
  CHECK_THAT(found.optimum->peak.Y, WithinRel(5.509, 1e-4));
}

TEST_CASE("What masses on springs may not be is said", "[structures]") {
  const TemporaryFolder folder;
  const Mistake mistakes[] = {
      {"mass = [2.0]", "mass = []", ":3", "system.base.mass", "from 1 to 100 masses", "got 0"},
      {"mass = [2.0]", "mass = [-2.0]", ":3", "system.base.mass", "> 0", "-2"},
      {"stiffness = [3.0] }", "stiffness = [0.0] }", ":3", "system.base.stiffness", "not 0", ""},
      {"stiffness = [3.0] }", "stiffness = [3.0, 1.0] }", ":3", "system.base.stiffness", "1 numbers",
       "got 2"},
      {"stiffness = [3.0] }", "stiffness = [3.0], contact = 2 }", ":3", "system.base.contact", "<= 1",
       "got 2"},
      {"stiffness = [3.0] }", "stiffness = [3.0], load = [] }", ":3", "system.base.load", "1 numbers",
       "got 0"},
      {"force = 1.2", "wave_number = 2", ":7", "system.wave_number", "unknown key", ""},
      {"[branch]", "[geometry]\n[branch]", ":9", "geometry", "only for rods and beams", ""}};
  for (const Mistake& mistake : mistakes) {
    const std::string path =
        folder.write("case.toml", replaced(one_mass + mass_over_eta, mistake.from, mistake.to));
    check_message(error_of([&] { read_case(path); }), mistake);
  }
}
