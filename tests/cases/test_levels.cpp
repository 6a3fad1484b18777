// Curves along which an observable has a value: also where this is that of a corner to the last digit.

#include <fmt/format.h>

#include "cycle_cases.hpp"

namespace {

using namespace arcslip;
using namespace arcslip::testing;

/// Rods that meet their stops at Y = 0.5 and begin to slip at R/S = 1.
const std::string rods_between_stops = R"case([system]
model = "rods"
wave_number = 1
elements = 5
mass_ratio = 3.0
frequency_ratio = 1.5
interface_stiffness = 40.0
damping = { base = 1e-3, damper = 1e-3 }
force = 1.0
preload = 0.05
[[element]]
kind = "clearance"
at = "base"
stiffness = 60.0
gap = 0.5
[branch]
)case";

/// eta on all curves of a level where they pass the preload of the system, ascending.
std::vector<double> passed(const std::string& observable, double level) {
  const auto all =
      traced_of(rods_between_stops + fmt::format("curve = \"level\"\nlevel_of = \"{}\"\nlevel = {}\n"
                                                 "parameters = [\"eta\", \"P\"]\nwindow = [0.5, "
                                                 "5.0]\nfrom = 0.01\nto = 0.2\n",
                                                 observable, level));
  std::vector<double> found;
  for (const TracedBranch& one : all) {
    CHECK(one.branch.complete());
    for (const BranchPoint& point : one.branch.points) {
      CHECK_THAT(value(one, point, observable), WithinAbs(level, 1e-9 * level));
      if (value(one, point, "P") == 0.05) found.push_back(value(one, point, "eta"));
    }
  }
  std::sort(found.begin(), found.end());
  return found;
}

}  // namespace

TEST_CASE("Levels that are reached exactly on corners of the response are followed", "[cases]") {
  const auto response = traced_of(rods_between_stops + "parameter = \"eta\"\nfrom = 0.5\nto = 5.0\n");
  REQUIRE(response.size() == 1);
  std::vector<double> slips;
  std::vector<double> meets_stops;
  for (const BranchPoint& point : points(response[0], PointType::regime_switch)) {
    const double amplitude = value(response[0], point, "Y");
    const double eta = value(response[0], point, "eta");
    (std::abs(amplitude - 0.5) < 1e-9 ? meets_stops : slips).push_back(eta);
  }
  REQUIRE(meets_stops.size() == 2);
  REQUIRE(slips.size() == 3);
  check_values(passed("Y", 0.5), meets_stops, 1e-9);
  check_values(passed("R_over_S", 1), slips, 1e-9);
  check_values(passed("Y", 0.5 + 1e-9), meets_stops, 1e-8);  // a little beside it is the same
  check_values(passed("Y", 0.5 - 1e-9), meets_stops, 1e-8);
}
