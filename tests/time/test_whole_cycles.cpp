// Disturbances of limit cycles that are not odd or rub in a plane, against all nodes in time.

#include <cmath>

#include "arcslip/structure/spectrum.hpp"
#include "catch.hpp"
#include "draws.hpp"
#include "monodromy.hpp"
#include "temporary_folder.hpp"
#include "timed_cases.hpp"
#include "timed_cycle.hpp"

using namespace arcslip;
using namespace arcslip::testing;

namespace {

const std::string one_stop =
    "[[element]]\nkind = \"unilateral\"\nat = \"contact\"\ncontact = 2\nstiffness = 1.5\ngap = 0.05\n";

/// Three masses, of which the first and the last are joined a little.
Case three_masses(int highest, double contact, const std::string& more) {
  const TemporaryFolder folder;
  const std::string head = "%%MatrixMarket matrix array real symmetric\n3 3\n";
  folder.write("m.mtx", head + "1\n0\n0\n1\n0\n1\n");
  folder.write("k.mtx", head + "1\n0\n0.2\n2\n0\n1.5\n");
  return read_case(folder.write(
      "case.toml",
      fmt::format(
          "[system]\nmodel = \"sector\"\ncontact_stiffness = [{}, 0, 0]\npreload = 1.0\n"
          "damping.base = 1e-2\nharmonics = {}\nreduction_window = [0.01, 3.0]\n[system.base]\nmass = "
          "\"m.mtx\"\nstiffness = \"k.mtx\"\ncontact = [1, 2, 3]\ndamping_kind = \"viscous\"\n"
          "reference_frequency = 0.15915494309189535\nload = {{ dof = [1], value = [1.0] }}\n"
          "[[element]]\nat = \"base\"\n{}\n[branch]\nresponse = \"limit_cycle\"\n"
          "parameter = \"zeta_B\"\nstart = -2e-2\nfrom = -1e-2\nto = -0.3\nstability = true\n",
          contact, highest, more)));
}

/// The first of them rubs as the last one presses it, and lifts off.
Case that_lifts_off(int highest) {
  return three_masses(
      highest, 0,
      "kind = \"friction\"\ncontact = 1\nnormal = 3\ntangential_stiffness = 0.6\nnormal_stiffness = 0.8\n"
      "mu = 0.5\nnormal_per_preload = 1.0");
}

/// Rods that are free to move, with a spring and a stop on one side between base and damper.
Case joined_rods(int highest) {
  return case_of(rods(
      highest,
      "kind = \"dashpot\"\ndamping = 0.02\n[[element]]\nat = \"contact\"\nkind = \"polynomial\"\n"
      "linear = 4.0\n[[element]]\nat = \"contact\"\nkind = \"unilateral\"\nstiffness = 20.0\ngap = 0.02"));
}

/// A cycle in harmonics.
struct BalancedCycle {
  BalancedCycle(const Case& input, double zeta)
      : system(with_damping(input.branches.front().problem.system, zeta)),
        problem(build_harmonic_system(system), ring_waves(system, highest_order(system.harmonics) + 1)),
        at(problem.guess(zeta, system.preload)) {}
  static SystemParameters with_damping(SystemParameters system, double zeta) {
    system.base_damping = zeta;
    return system;
  }

  SystemParameters system;
  FloquetCycle problem;
  continuation::Guess at;
};

/// The farthest of a cycle's multipliers from one of all nodes in time, beside which there are but
/// multipliers 1.
double cycle_error(const BalancedCycle& cycle) {
  TimedCycle time(cycle.system, cycle.at);
  CHECK(time.settle(6) < 1e-12);
  const ComplexVector found = multipliers(cycle.problem, cycle.at);
  Index others = 0;
  const ComplexVector expected = spectrum(monodromy(time.motion, time.state));
  for (const Complex& mu : expected) others += std::abs(mu) > 1e-2 && std::abs(mu - 1.0) > 1e-6 ? 1 : 0;
  CHECK(found.size() == others);
  return worst_match(found, expected);
}

}  // namespace

TEST_CASE(
    "Multipliers of cycles beside any element are those of all nodes in time, without that of the phase",
    "[stability][cycle][whole]") {
  struct Row {
    std::string name;
    Case input;
    double zeta;
    double as_near;
  };
  // Waves with and without a common factor; odd and not.
  constexpr std::size_t rows = sanitized ? 3 : 6;
  const auto row = GENERATE(take(
      rows,
      values<std::function<Row()>>({
          [] {
            return Row{"a stop", case_of(sectors(1, 4, 9, one_stop)), -2e-3, 3e-4};
          },
          [] {
            return Row{"a plane", case_of(sectors(1, 4, 5, circle)), -2e-3, 1e-4};
          },
          [] {
            return Row{"free rods", joined_rods(9), -2.22e-2, 5e-4};
          },
          [] {
            return Row{"lift-off", case_of(sectors(2, 4, 9, lift_off)), -6e-3, 1e-4};
          },
          [] {
            return Row{"lift-off and a stop", case_of(sectors(2, 6, 9, lift_off + one_stop)), -6e-3, 2e-4};
          },
          [] {
            return Row{"a plane, g = 2", case_of(sectors(2, 6, 5, circle)), -6e-3, 6e-4};
          },
      })))();
  CAPTURE(row.name);
  CHECK(cycle_error({row.input, row.zeta}) < row.as_near);
}

TEST_CASE("They tend to these as H^-3, and not as the velocity of the cycle alone does",
          "[stability][cycle][whole][numbers]") {
  const double few = cycle_error({that_lifts_off(7), -2e-2});
  const double many = cycle_error({that_lifts_off(15), -2e-2});
  CAPTURE(few, many);
  CHECK(few < 2e-4);
  CHECK(many < 2e-5);
}

TEST_CASE("Disturbed cycles with even harmonics leave in time as their growth says",
          "[stability][cycle][whole]") {
  const auto [input, zeta] = GENERATE(table<std::function<Case()>, double>(
      {{[] { return case_of(sectors(2, 6, 9, lift_off + one_stop)); }, -6e-3},
       {[] { return case_of(sectors(1, 4, 9, one_stop)); }, -6e-3}}));
  const BalancedCycle cycle(input(), zeta);
  const double growth = cycle.problem.worst(cycle.at.unknowns, cycle.at.parameters, cycle.at.regime).growth;
  TimedCycle time(cycle.system, cycle.at);
  REQUIRE(time.settle(6) < 1e-12);
  CHECK_THAT(time.growth(6, 8), WithinRel(growth, 0.02));
}

TEST_CASE("Along cycles that meet a stop on one side exponents change their number at the fold alone",
          "[stability][cycle][whole]") {
  const Case input = three_masses(3, 0.6, "kind = \"unilateral\"\ncontact = 3\nstiffness = 1.0\ngap = 0.8");
  const TracedBranch traced = std::move(trace(input.branches.front()).front());
  const std::vector<BranchPoint>& all = traced.branch.points;
  REQUIRE(count(traced, PointType::fold) == 1);
  bool behind = false;
  std::size_t seen = 0;
  for (const BranchPoint& point : all) {
    behind = behind || point.type == PointType::fold;
    if (point.type == PointType::fold) continue;
    CAPTURE(point.parameters(0));
    CHECK(point.unstable == (behind ? 5 : 4));
    ++seen;
  }
  CHECK(seen > 20);
}
