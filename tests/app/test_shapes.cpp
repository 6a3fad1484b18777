// Shapes of modes and responses as ParaView reads them.

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <complex>
#include <sstream>
#include <string>
#include <vector>

#include "arcslip/types.hpp"
#include "catch.hpp"
#include "composition.hpp"

namespace arcslip::testing {
namespace {

using Place = std::array<double, 3>;

/// Triples of numbers of the array of this name; of the points that of none.
std::vector<Place> array_of(const std::string& text, const std::string& name) {
  const std::size_t at = text.find(name.empty() ? "<Points>" : "Name=\"" + name + "\"");
  REQUIRE(at != std::string::npos);
  const std::size_t begin = text.find(">\n", text.find("format=\"ascii\"", at)) + 2;
  std::istringstream in(text.substr(begin, text.find('<', begin) - begin));
  std::vector<Place> all;
  for (Place one; in >> one[0] >> one[1] >> one[2];) all.push_back(one);
  return all;
}

double length(const Place& a) { return std::hypot(a[0], a[1], a[2]); }
Place difference(const Place& a, const Place& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }

/// Four dofs of a sector, one of twelve: three along an arc about z, the first of which is radial, and the
/// first of the next sector.
std::string places(double sense, int sectors = 12) {
  std::string text;
  for (int dof = 1; dof <= 4; ++dof) {
    const double angle = sense * arcslip::two_pi / sectors * (dof - 1) / 3;
    const bool radial = dof == 1 || dof == 4;
    text += fmt::format("{} {:.17g} {:.17g} 0.5 {:.17g} {:.17g} {}\n", dof, 2 * std::cos(angle),
                        2 * std::sin(angle), radial ? 3 * std::cos(angle) : 0,
                        radial ? 3 * std::sin(angle) : 0, radial ? 0 : 1);
  }
  return text;
}

/// The case of a sector whose dofs have places; its waves go round three times.
std::string placed_sector(const composition::Cells& cells, double sense) {
  std::string text = composition::sector("[1, 3]", "");
  cells.folder().write("places.txt", places(sense));
  for (const char* part : {"base", "damper"}) {
    const std::string begins = fmt::format("[system.{}]\n", part);
    text.insert(text.find(begins) + begins.size(), "coordinates = \"places.txt\"\noutput = [2, 3]\n");
  }
  text.replace(text.find("wave_number = 1"), 15, "wave_number = 3");
  return text;
}

/// Whether what is told twice, of the right of a sector and of the left of the next, is the same.
void check_seams(const std::string& text, const std::string& name, std::size_t parts) {
  const std::vector<Place> points = array_of(text, "");
  const std::vector<Place> real = array_of(text, name + "_real");
  const std::vector<Place> imaginary = array_of(text, name + "_imaginary");
  REQUIRE(points.size() == parts * 48);
  REQUIRE(real.size() == points.size());
  REQUIRE(imaginary.size() == points.size());
  for (std::size_t part = 0; part < parts; ++part) {
    for (std::size_t sector = 0; sector < 12; ++sector) {
      const std::size_t right = 48 * part + 4 * sector + 3;
      const std::size_t left = 48 * part + 4 * ((sector + 1) % 12);
      CHECK(length(difference(points[right], points[left])) < 1e-8);
      CHECK(length(difference(real[right], real[left])) < 1e-8);
      CHECK(length(difference(imaginary[right], imaginary[left])) < 1e-8);
    }
  }
}

}  // namespace

TEST_CASE("Shapes of modes go round the ring as their wave does", "[shapes]") {
  const composition::Cells cells(composition::kinds().front());
  const double sense = GENERATE(1.0, -1.0);
  const std::string branch = "[branch]\nparameter = \"eta\"\nfrom = 0.1\nto = 0.6\n";
  const std::string path = cells.folder().write("case.toml", placed_sector(cells, sense) + branch);
  const Outcome outcome =
      arcslip_program(fmt::format("modes '{}' -o '{}' --shapes --quiet", path, cells.folder().path("modes")));
  INFO(outcome.err);
  REQUIRE(outcome.status == 0);
  for (const std::string part : {"base", "damper", "stuck"}) {
    const std::string text = read(cells.folder().path("modes/shapes/n3_" + part + "_1.vtu"));
    check_seams(text, "mode", part == "stuck" ? 2 : 1);
    // The greatest motion is 1, and a quarter of the way round 3 waves are three quarters of a wave.
    const std::vector<Place> real = array_of(text, "mode_real");
    const std::vector<Place> imaginary = array_of(text, "mode_imaginary");
    double greatest = 0;
    for (std::size_t i = 0; i < real.size(); ++i)
      greatest = std::max(greatest, std::hypot(length(real[i]), length(imaginary[i])));
    CHECK_THAT(greatest, Catch::Matchers::WithinRel(1, 1e-8));
    for (std::size_t point : {1, 2}) {  // along z, which does not turn
      const std::complex<double> first(real[point][2], imaginary[point][2]);
      const std::complex<double> quarter(real[12 + point][2], imaginary[12 + point][2]);
      CHECK(std::abs(quarter - first * std::complex<double>(0, 1)) < 1e-8);
    }
  }
}

TEST_CASE("Shapes of responses have the amplitudes of the tables", "[shapes]") {
  const composition::Cells cells(composition::kinds().front());
  const std::string harmonics = GENERATE("1", "5");
  const std::string branch = "[branch]\nparameter = \"eta\"\nfrom = 0.1\nto = 0.6\n";
  const std::string path = cells.folder().write("case.toml", placed_sector(cells, 1) + branch);
  const Outcome outcome =
      arcslip_program(fmt::format("run '{}' -o '{}' --shapes --quiet --set system.harmonics={}", path,
                                  cells.folder().path("out"), harmonics));
  INFO(outcome.err);
  REQUIRE(outcome.status == 0);
  const composition::Table table(cells.folder().path("out/branches.csv"));
  std::size_t shapes = 0;
  for (std::size_t row = 0; row < table.rows.size(); ++row) {
    if (table.text(row, "type") == "regular") continue;
    const std::string text =
        read(cells.folder().path(fmt::format("out/shapes/branch_0_point_{}.vtu", table.text(row, "point"))));
    check_seams(text, "harmonic_1", 2);
    if (harmonics == "5") check_seams(text, "harmonic_5", 2);
    const std::vector<Place> real = array_of(text, "harmonic_1_real");
    const std::vector<Place> imaginary = array_of(text, "harmonic_1_imaginary");
    const auto size = [&](std::size_t i) { return std::hypot(length(real[i]), length(imaginary[i])); };
    for (const int dof : {2, 3}) {
      const auto i = static_cast<std::size_t>(dof - 1);
      CHECK_THAT(size(i), Catch::Matchers::WithinRel(table(row, fmt::format("Y_{}", dof)), 1e-5));
      CHECK_THAT(size(48 + i), Catch::Matchers::WithinRel(table(row, fmt::format("U_{}", dof)), 1e-5));
    }
    ++shapes;
  }
  CHECK(shapes >= 4);
}

TEST_CASE("Of two sectors both senses of turning are one", "[shapes]") {
  const composition::Cells cells(composition::kinds().front());
  std::string text = placed_sector(cells, 1);
  text.replace(text.find("sectors = 12"), 12, "sectors = 2");
  text.replace(text.find("wave_number = 3"), 15, "wave_number = 1");
  cells.folder().write("places.txt", places(1, 2));
  cells.folder().write("opposite.txt", places(-1, 2));
  text.replace(text.rfind("places.txt"), 10, "opposite.txt");
  const std::string path =
      cells.folder().write("case.toml", text + "[branch]\nparameter = \"eta\"\nfrom = 0.1\nto = 0.6\n");
  const Outcome outcome =
      arcslip_program(fmt::format("run '{}' -o '{}' --shapes --quiet", path, cells.folder().path("out")));
  INFO(outcome.err);
  CHECK(outcome.status == 0);
}

TEST_CASE("Shapes without places of the dofs are refused before anything is done", "[shapes]") {
  const composition::Cells cells(composition::kinds().front());
  const auto refused = [&](const std::string& text, const std::string& command, const std::string& why) {
    const std::string path = cells.folder().write("case.toml", text);
    const Outcome outcome =
        arcslip_program(fmt::format("{} '{}' -o '{}' --shapes", command, path, cells.folder().path("none")));
    CHECK(outcome.status == 1);
    CHECK(is_one_line(outcome.err));
    CHECK_THAT(outcome.err, Catch::Matchers::Contains(why));
  };
  const std::string branch = "[branch]\nparameter = \"eta\"\nfrom = 0.1\nto = 0.6\n";
  const std::string placed = placed_sector(cells, 1) + branch;
  for (const std::string command : {"run", "modes"}) {
    refused(composition::rods("") + branch, command, "rods, beams and masses");
    refused(composition::sector("[1]", "") + branch, command, "system.base has no `coordinates`");
    std::string twelve = placed;
    twelve.replace(twelve.find("sectors = 12"), 12, "sectors = 11");
    refused(twelve, command, "turned by 360/11 degrees");
  }
  cells.folder().write("opposite.txt", places(-1));
  std::string opposite = placed;
  opposite.replace(opposite.rfind("places.txt"), 10, "opposite.txt");
  refused(opposite, "modes", "opposite senses");
  cells.folder().write("places.txt", "1 0 0 0 0 0 0\n");
  refused(placed, "run", "direction");
  cells.folder().write("places.txt", "1 0 0 0 0 0 1\n");
  refused(placed, "run", "dof 2 has none");
}

}  // namespace arcslip::testing
