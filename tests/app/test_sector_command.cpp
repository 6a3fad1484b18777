// What `arcslip sector` writes.

#include <fmt/format.h>

#include <map>

#include "arcslip/sectors/annular_plate.hpp"
#include "arcslip/sectors/chain_sector.hpp"
#include "arcslip/sectors/lowest_frequency.hpp"
#include "arcslip/sectors/matrix_market.hpp"
#include "arcslip/time/ring_sector.hpp"
#include "catch.hpp"
#include "program.hpp"
#include "sector_frequencies.hpp"

using namespace arcslip;
using testing::arcslip_program;
using testing::read;

namespace {

AnnularPlate plate() {
  return {.inner_radius = 0.07,
          .outer_radius = 0.14,
          .thickness = 0.012,
          .youngs_modulus = 110e9,
          .poisson_ratio = 0.26,
          .density = 7200,
          .inner_edge = EdgeSupport::clamped,
          .outer_edge = EdgeSupport::free,
          .sectors = 24,
          .radial_elements = 3,
          .angular_elements = 2};
}

SolidRing ring() {
  return {.radius = 0.14,
          .width = 0.004,
          .height = 0.006,
          .youngs_modulus = 210e9,
          .poisson_ratio = 0.29,
          .density = 7850,
          .contact = RingDirection::axial,
          .sectors = 24,
          .elements = 2};
}

void check_files(const testing::TemporaryFolder& folder, const std::string& name,
                 const FiniteSector& sector) {
  const auto path = [&](const char* what) { return folder.path(fmt::format("rotor/{}_{}", name, what)); };
  for (const auto& [what, matrix] :
       {std::pair{"mass.mtx", &sector.mass}, {"stiffness.mtx", &sector.stiffness}}) {
    const SparseMatrix again = read_matrix_market(read(path(what)), what);
    REQUIRE(again.nonZeros() == matrix->nonZeros());
    CHECK(std::equal(again.valuePtr(), again.valuePtr() + again.nonZeros(), matrix->valuePtr()));
    CHECK(
        std::equal(again.innerIndexPtr(), again.innerIndexPtr() + again.nonZeros(), matrix->innerIndexPtr()));
  }
  CHECK(read_dofs(read(path("left.txt")), "left.txt", sector.mass.rows()) == sector.left);
  CHECK(read_dofs(read(path("right.txt")), "right.txt", sector.mass.rows()) == sector.right);
}

/// Rows of branches.csv at points that are no regular ones, by the names of the columns.
std::vector<std::map<std::string, std::string>> special_points(const std::string& folder) {
  const auto rows = testing::read_csv(folder + "/branches.csv");
  std::vector<std::map<std::string, std::string>> special;
  for (std::size_t i = 1; i < rows.size(); ++i) {
    std::map<std::string, std::string> row;
    for (std::size_t k = 0; k < rows[0].size(); ++k) row[rows[0][k]] = rows[i][k];
    if (row["type"] != "regular") special.push_back(row);
  }
  return special;
}

void run_case(const std::string& case_path, const std::string& results) {
  const auto outcome = arcslip_program(fmt::format("run '{}' -o '{}' --quiet", case_path, results));
  CHECK(outcome.err.empty());
  REQUIRE(outcome.status == 0);
}

}  // namespace

TEST_CASE("arcslip sector plate writes the matrices to the last bit, and no file besides", "[program]") {
  const testing::TemporaryFolder folder;
  const auto outcome =
      arcslip_program("sector plate --radial-elements 3 --angular-elements 2 --ring-elements 2 -o '" +
                      folder.path("rotor") + "'");
  CHECK(outcome.err.empty());
  REQUIRE(outcome.status == 0);
  check_files(folder, "base", annular_plate_sector(plate()));
  check_files(folder, "damper", ring_sector(ring()));
  CHECK(testing::names_in(folder.path("rotor")) ==
        std::set<std::string>{"base_mass.mtx", "base_stiffness.mtx", "base_left.txt", "base_right.txt",
                              "base_load.txt", "damper_mass.mtx", "damper_stiffness.mtx", "damper_left.txt",
                              "damper_right.txt", "case.toml"});
  // Two of the rim's three nodes are this sector's: a half each, 3 waves over half a sector of 15 degrees.
  CHECK_THAT(read(folder.path("rotor/base_load.txt")),
             ContainsSubstring(fmt::format("\n9 0.5 0\n21 {:.17g} ", 0.5 * std::cos(std::numbers::pi / 8))));
  CHECK_THAT(read(folder.path("rotor/case.toml")), ContainsSubstring("contact = [9]\n"));
}

TEST_CASE("arcslip sector beams writes the paper's elements with their load", "[program]") {
  const testing::TemporaryFolder folder;
  REQUIRE(arcslip_program("sector beams --wave-number 1 --elements-per-sector 3 -o '" + folder.path("rotor") +
                          "'")
              .status == 0);
  check_files(folder, "base", chain_sector(beam_element(5, 80, 1, 30), 1, 30, 3));
  check_files(folder, "damper", chain_sector(beam_element(1, 1, 1, 30), 1, 30, 3));
  const std::string text = read(folder.path("rotor/case.toml"));
  CHECK_THAT(text, ContainsSubstring("sectors = 10\n"));
  CHECK_THAT(text, ContainsSubstring("contact = [1, 3, 5]\n"));
  CHECK_THAT(text, ContainsSubstring("reference_frequency = 4\n"));
  // K_FD/N = 12 (33.3)^4/1.3/30 and K*/N = 80/30.
  CHECK_THAT(text, ContainsSubstring("contact_stiffness = 378349.8560307"));
  CHECK_THAT(text, ContainsSubstring("limit_per_preload = 2.6666666666666665\n"));
}

TEST_CASE("What arcslip sector cannot make is named in one line, and nothing is written", "[program]") {
  struct Example {
    const char* arguments;
    int status;
    const char* message;
  };
  const auto example = GENERATE(values<Example>({
      {"plate --inner-edge free --wave-number 1", 1,
       "the base moves freely at n = 1: --from and --to are needed"},
      {"plate --contacts 3", 1,
       "--contacts: expected a divisor of the 2 elements of the base's contact line, got 3"},
      {"plate --wave-number 13", 1, "--wave-number: expected at most half of the 24 sectors, got 13"},
      {"plate --inner-radius 0.2", 1, "--inner-radius: expected less than --outer-radius, 0.14, got 0.2"},
      {"plate --outer-edge clamped", 1, "--outer-edge: expected free, since the damper rubs there"},
      {"plate --to 1", 1, "--from: expected less than --to, 1, got"},
      {"plate --thickness -1", 2, "--thickness"},
  }));
  const testing::TemporaryFolder folder;
  const auto outcome = arcslip_program(fmt::format(
      "sector {} --radial-elements 3 --angular-elements 2 -o '{}'", example.arguments, folder.path("rotor")));
  CHECK(outcome.status == example.status);
  CHECK(testing::is_one_line(outcome.err));
  CHECK_THAT(outcome.err, ContainsSubstring(example.message));
  CHECK_FALSE(std::filesystem::exists(folder.path("rotor")));
}

TEST_CASE("The lowest frequency is that of the dense matrices, alone and joined by the contact") {
  const FiniteSector base = annular_plate_sector(plate());
  const FiniteSector damper = ring_sector(ring());
  const double alone = std::sqrt(testing::squared_frequencies(base, 3, 24)(0)) / (2 * std::numbers::pi);
  CHECK_THAT(lowest_frequency(base, 3, 24), WithinRel(alone, 1e-8));
  const FiniteSector both = joined(base, damper, 1e6);
  const double held = std::sqrt(testing::squared_frequencies(both, 3, 24)(0)) / (2 * std::numbers::pi);
  CHECK_THAT(lowest_frequency(both, 3, 24), WithinRel(held, 1e-8));
  CHECK(held < alone);
  CHECK(lowest_frequency(damper, 0, 24) == 0);
}

TEST_CASE("The beams that arcslip sector writes have the special points of the built-in model", "[program]") {
  const testing::TemporaryFolder folder;
  REQUIRE(arcslip_program("sector beams --wave-number 1 --from 3 --to 5 -o '" + folder.path("beams") + "'")
              .status == 0);
  run_case(folder.path("beams/case.toml"), folder.path("written"));
  run_case(
      folder.write(
          "case.toml",
          "[system]\nmodel = 'beams'\nwave_number = 1\nelements = 30\nmass_ratio = 5\nfrequency_ratio = 4\n"
          "slenderness = 33.3\nforce = 1\n[branch]\nparameter = 'eta'\nfrom = 3\nto = 5\n"
          "for_each = { preload = [0.01, 1, 100] }\n"),
      folder.path("built_in"));
  const auto written = special_points(folder.path("written"));
  const auto expected = special_points(folder.path("built_in"));
  REQUIRE(written.size() == expected.size());
  REQUIRE(written.size() > 10);
  for (std::size_t i = 0; i < written.size(); ++i) {
    CHECK(written[i].at("type") == expected[i].at("type"));
    for (const char* column : {"eta", "P", "R", "S", "Y", "U"}) {
      CAPTURE(i, column);
      // Points are located to 1e-10, and double matrices leave about as much of the elements' stiffness.
      CHECK_THAT(std::stod(written[i].at(column)), WithinRel(std::stod(expected[i].at(column)), 1e-8));
    }
  }
}

TEST_CASE("The rotor resonates as the base alone under a light preload, and joined under a heavy one",
          "[program]") {
  const testing::TemporaryFolder folder;
  REQUIRE(arcslip_program("sector plate --radial-elements 3 --angular-elements 2 --ring-elements 2 "
                          "--contact-stiffness 1e9 --preload 10 --base-damping 1e-3 -o '" +
                          folder.path("rotor") + "' ")
              .status == 0);
  REQUIRE(arcslip_program("run '" + folder.path("rotor/case.toml") + "' -o '" + folder.path("out") +
                          "' --quiet --set 'branch.for_each={ preload = [1e-4, 1e5] }'")
              .status == 0);
  double highest[2] = {0, 0};
  double eta[2] = {0, 0};
  for (const auto& point : special_points(folder.path("out"))) {
    const auto branch = static_cast<std::size_t>(std::stoi(point.at("branch")));
    if (point.at("type") != "peak" || std::stod(point.at("Y")) < highest[branch]) continue;
    highest[branch] = std::stod(point.at("Y"));
    eta[branch] = std::stod(point.at("eta"));
  }
  FiniteSector base = annular_plate_sector(plate());
  FiniteSector damper = ring_sector(ring());
  base.contacts.resize(1);
  damper.contacts.resize(1);
  // Damping and the little friction move a peak by squares of a thousandth.
  CHECK_THAT(eta[0], WithinRel(lowest_frequency(base, 3, 24), 1e-5));
  CHECK_THAT(eta[1], WithinRel(lowest_frequency(joined(base, damper, 1e9), 3, 24), 1e-5));
}
