// The Campbell diagram that `arcslip modes` writes.

#include <cmath>
#include <map>
#include <set>
#include <tuple>

#include "catch.hpp"
#include "program.hpp"
#include "temporary_folder.hpp"

using namespace arcslip::testing;

namespace {

using CampbellTable = std::vector<std::vector<std::string>>;

std::string turning_case() { return case_named("turning_disk"); }

/// eta over the speed of one wave, part and mode.
std::map<double, double> campbell_line(const CampbellTable& table, const std::string& wave,
                                       const std::string& part, const std::string& mode) {
  std::map<double, double> line;
  for (const auto& row : table) {
    if (row[1] == wave && row[2] == part && row[3] == mode) line[std::stod(row[0])] = std::stod(row[4]);
  }
  return line;
}

}  // namespace

TEST_CASE("A Campbell diagram has both directions of a wave, and crossings that lie on its lines",
          "[rotation]") {
  const TemporaryFolder folder;
  const Outcome run =
      arcslip_program("modes '" + turning_case() + "' --campbell 0 60 -o '" + folder.path("m") + "'");
  CAPTURE(run.err);
  REQUIRE(run.status == 0);
  const CampbellTable table = read_csv(folder.path("m/campbell.csv"));
  CHECK(table.front() ==
        std::vector<std::string>{"speed", "wave_number", "part", "mode", "eta", "frequency_Hz", "zeta"});
  const auto forward = campbell_line(table, "3", "stuck", "1");
  const auto backward = campbell_line(table, "-3", "stuck", "1");
  REQUIRE((forward.size() == 101 && backward.size() == 101));
  CHECK_THAT(forward.at(0), WithinRel(backward.at(0), 1e-9));
  CHECK(std::abs(forward.at(60) - backward.at(60)) > 1e-3 * forward.at(60));
  const CampbellTable crossings = read_csv(folder.path("m/crossings.csv"));
  int met = 0;
  for (std::size_t i = 1; i < crossings.size(); ++i) {
    const auto& row = crossings[i];
    const double order = std::stod(row[0]);
    const double speed = std::stod(row[4]);
    const double eta = std::stod(row[5]);
    CAPTURE(order, row[1], row[2], row[3]);
    CHECK((std::lround(order) + std::stol(row[1])) % 24 == 0);
    CHECK_THAT(eta, WithinRel(order * speed, 1e-14));
    // Between two speeds of the nearest line: of the second order in their distance.
    double nearest = 1;
    for (const std::string mode : {"1", "2", "3", "4", "5", "6"}) {
      const auto line = campbell_line(table, row[1], row[2], mode);
      const auto above = line.upper_bound(speed);
      if (line.empty() || above == line.end() || above == line.begin()) continue;
      const auto below = std::prev(above);
      const double part = (speed - below->first) / (above->first - below->first);
      nearest =
          std::min(nearest, std::abs(below->second + part * (above->second - below->second) - eta) / eta);
    }
    CHECK(nearest < 1e-4);
    ++met;
  }
  CHECK(met > 3);
}

TEST_CASE("The peak of a branch over the speed is where its engine order crosses the free mode",
          "[rotation]") {
  const TemporaryFolder folder;
  REQUIRE(arcslip_program("modes '" + turning_case() + "' --campbell 0 60 -o '" + folder.path("m") + "'")
              .status == 0);
  // Hardly pressed contacts leave the base as if alone; the mode's frequency is met to its damping squared.
  REQUIRE(arcslip_program("run '" + turning_case() +
                          "' --set system.preload=1e-6 --set system.preload_speed2=1e-12 -o '" +
                          folder.path("r") + "'")
              .status == 0);
  const CampbellTable crossings = read_csv(folder.path("m/crossings.csv"));
  const CampbellTable rows = read_csv(folder.path("r/branches.csv"));
  std::vector<double> peaks;
  for (const auto& row : rows) {
    if (row[2] == "peak") peaks.push_back(std::stod(row[4]));
  }
  int found = 0;
  for (const auto& row : crossings) {
    if (row[0] != "3" || row[2] != "base") continue;
    for (const double eta : peaks) found += std::abs(eta / std::stod(row[5]) - 1) < 1e-4 ? 1 : 0;
  }
  CHECK(found == static_cast<int>(peaks.size()));
  CHECK(found >= 2);
}

TEST_CASE("What has no Campbell diagram is refused in one line", "[rotation]") {
  const TemporaryFolder folder;
  const Outcome run =
      arcslip_program("modes '" + case_named("rods") + "' --campbell 0 1 -o '" + folder.path("m") + "'");
  CHECK(run.status == 1);
  CHECK_THAT(run.err, ContainsSubstring("a Campbell diagram is of sectors that feel rotation"));
  const Outcome wrong =
      arcslip_program("modes '" + turning_case() + "' --campbell 3 1 -o '" + folder.path("n") + "'");
  CHECK(wrong.status == 1);
  CHECK_THAT(wrong.err, ContainsSubstring("two speeds, 0 <= low < high"));
}

TEST_CASE("Rings and plates that turn are written with their matrices, and run", "[rotation]") {
  const TemporaryFolder folder;
  const auto make = [&](const std::string& options) {
    const Outcome made =
        arcslip_program("sector " + options + " --speed 40 --wave-number 3 -o '" + folder.path("r") + "'");
    CAPTURE(made.err);
    REQUIRE(made.status == 0);
    CHECK_THAT(read(folder.path("r/case.toml")), ContainsSubstring("\nspeed = 40\n"));
    CHECK(arcslip_program("run '" + folder.path("r/case.toml") +
                          "' --set branch.for_each.preload=[1.0] -o '" + folder.path("o") + "'")
              .status == 0);
    return read(folder.path("r/case.toml"));
  };
  const std::string ring = "ring --elements 3 --ring-elements 3 --contact ";
  CHECK_THAT(make(ring + "radial"), ContainsSubstring("gyroscopic = \"base_gyroscopic.mtx\""));
  // Free, it flies away under n = 1; the case's own wave is held.
  const Outcome modes =
      arcslip_program("modes '" + folder.path("r/case.toml") + "' --to 3 -o '" + folder.path("m") + "'");
  CHECK(modes.status == 0);
  CHECK_THAT(modes.out,
             ContainsSubstring("\n    1  none: base: the stiffness K + Omega^2 K_2 is not positive"));
  std::set<std::string> waves;
  for (const auto& row : read_csv(folder.path("m/modes.csv"))) waves.insert(row[0]);
  CHECK((waves.count("3") == 1 && waves.count("-3") == 1 && waves.count("1") == 0));
  for (const std::string& flat :
       {ring + "axial", std::string("plate --radial-elements 3 --angular-elements 3 "
                                    "--ring-elements 3")}) {
    const std::string text = make(flat);  // along the axis Coriolis' forces do not act
    CHECK_THAT(text,
               !ContainsSubstring("gyroscopic") && ContainsSubstring("\"damper_stiffness_speed2.mtx\""));
  }
}
