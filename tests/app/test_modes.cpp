// arcslip modes: natural frequencies over the number of waves.

#include <cmath>
#include <cstdio>
#include <map>
#include <sstream>

#include "case_texts.hpp"
#include "catch.hpp"
#include "places.hpp"
#include "program.hpp"

using namespace arcslip;
using namespace arcslip::testing;

namespace {

using Key = std::pair<int, std::string>;

/// eta of the first modes by wave and part.
std::map<Key, double> first_modes(const std::string& csv) {
  std::map<Key, double> found;
  std::istringstream lines(read(csv));
  std::string line;
  std::getline(lines, line);
  CHECK(line.starts_with("wave_number,part,mode,eta,"));
  while (std::getline(lines, line)) {
    std::istringstream fields(line);
    std::string wave, part, mode, eta;
    std::getline(fields, wave, ',');
    std::getline(fields, part, ',');
    std::getline(fields, mode, ',');
    std::getline(fields, eta, ',');
    if (mode == "1") found[{std::stoi(wave), part}] = std::stod(eta);
  }
  return found;
}

}  // namespace

TEST_CASE("modes gives rods the frequencies of their finite elements, for every wave") {
  const TemporaryFolder folder;
  const std::string path = folder.write(
      "rods.toml", case_texts::rods_under_force + "[branch]\nparameter = \"eta\"\nfrom = 0.5\nto = 3.0\n");
  const Outcome outcome = arcslip_program("modes " + path + " -o " + folder.path("m"));
  INFO(outcome.err);
  REQUIRE(outcome.status == 0);
  const std::map<Key, double> found = first_modes(folder.path("m/modes.csv"));
  for (int n = 1; n <= 5; ++n) {
    // w^2 = 6 N^2 (1 - cos a)/(2 + cos a) of linear elements with consistent mass, a = 2 pi n/N.
    const double cosine = std::cos(2 * pi * n / 12);
    const double damper = std::sqrt(6 * 144 * (1 - cosine) / (2 + cosine)) / (2 * pi);
    CHECK_THAT(found.at({n, "damper"}), WithinRel(damper, 1e-12));
    CHECK_THAT(found.at({n, "base"}), WithinRel(1.5 * damper, 1e-12));
    // The same two of mass m and stiffness k a node on a spring s: det(K - w^2 M) = 0.
    const double m = (2 + cosine) / 36;
    const double k = 24 * (1 - cosine);
    const double s = 40.0 / 12;
    const double base = (2.25 * 3 * k + s) / (3 * m);
    const double ring = (k + s) / m;
    const double half = (base + ring) / 2;
    const double square = half - std::sqrt(std::pow((base - ring) / 2, 2) + s * s / (3 * m * m));
    CHECK_THAT(found.at({n, "stuck"}), WithinRel(std::sqrt(square) / (2 * pi), 1e-12));
  }
  CHECK(found.size() == 15);
}

TEST_CASE("modes --amplitude tells what structure, flow and friction take of each wave, either way round") {
  const TemporaryFolder folder;
  const Outcome outcome =
      arcslip_program("modes --amplitude 0.5 --amplitude 1.7 " + source_folder() +
                      "/problems/flutter.toml --set system.harmonics=1 -o " + folder.path("m"));
  INFO(outcome.err);
  REQUIRE(outcome.status == 0);
  CHECK_THAT(outcome.out, ContainsSubstring("Damping ratio of the first stuck mode") &&
                              ContainsSubstring("R = 0.5") && ContainsSubstring("damping.csv"));
  std::istringstream lines(read(folder.path("m/damping.csv")));
  std::string line;
  std::getline(lines, line);
  CHECK(line == "wave_number,mode,R,eta,zeta");
  int rows = 0;
  for (int n = -5; n <= 6; ++n) {
    for (const double R : {0.5, 1.7}) {
      REQUIRE(std::getline(lines, line));
      double wave = 0, mode = 0, amplitude = 0, eta = 0, zeta = 0;
      REQUIRE(std::sscanf(line.c_str(), "%lf,%lf,%lf,%lf,%lf", &wave, &mode, &amplitude, &eta, &zeta) == 5);
      CAPTURE(n, R);
      CHECK(wave == n);
      CHECK(mode == 1);
      CHECK(amplitude == R);
      // 2 zeta w^2 = c w - Im A + k Im phi, w^2 = K(a) + k Re phi, with S = 1.
      const double x = R > 1 ? 1 / R : 1;
      const double turn = std::acos(1 - 2 * x);
      const double real = R > 1 ? (turn - std::sin(2 * turn) / 2) / pi : 1;
      const double w = std::sqrt(1.1 - 0.1 * std::cos(pi * n / 6) + 0.2 * real);
      const double taken = 0.005 * w - 0.02 * std::sin(pi * n / 6) + 0.2 * 4 / pi * x * (1 - x);
      CHECK_THAT(2 * pi * eta, WithinRel(w, 1e-9));
      CHECK_THAT(2 * zeta * w * w, WithinAbs(taken, 1e-10));
      ++rows;
    }
  }
  CHECK(rows == 24);
  CHECK(arcslip_program("modes --amplitude -1 " + source_folder() + "/problems/flutter.toml").status == 2);
}

TEST_CASE("modes refuses what has none and says why") {
  const Outcome library = arcslip_program("modes " + source_folder() + "/problems/enz.toml");
  CHECK(library.status == 1);
  CHECK(is_one_line(library.err));
  CHECK_THAT(library.err, ContainsSubstring("systems with friction"));
  const Outcome speed = arcslip_program("modes " + source_folder() + "/problems/figure_8.toml --speed 3000");
  CHECK(speed.status == 1);
  CHECK_THAT(speed.err, ContainsSubstring("SI units"));
  CHECK(arcslip_program("modes " + source_folder() + "/problems/figure_8.toml --speed -1").status == 2);
}
