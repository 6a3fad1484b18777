// Structures that are free to move as a whole: with n = 0 turning and moving along the axis, with n = 1
// moving across it and tilting.

#include <fmt/format.h>

#include <numbers>

#include "arcslip/problems/response/limit_cycle.hpp"
#include "arcslip/problems/response/nonlinear_mode.hpp"
#include "arcslip/sectors/lowest_frequency.hpp"
#include "arcslip/sectors/sector_modes.hpp"
#include "arcslip/time/ring_sector.hpp"
#include "catch.hpp"
#include "program.hpp"

using namespace arcslip;
using namespace arcslip::testing;

namespace {

constexpr Loss light{.structural = 2e-4};

/// The ring of a brake rotor.
SolidRing ring(RingDirection contact, Index elements) {
  return {.radius = 0.14,
          .width = 0.03,
          .height = 0.02,
          .youngs_modulus = 110e9,
          .poisson_ratio = 0.26,
          .density = 7200,
          .contact = contact,
          .sectors = 24,
          .elements = elements};
}

FiniteSector pressed(RingDirection contact, Index elements) {
  FiniteSector sector = ring_sector(ring(contact, elements));
  sector.contacts = {sector.contacts.front()};
  sector.load(sector.contacts.front()) = 1;
  return sector;
}

/// Both motions of the ring side by side, in contact along the circumference and along the axis.
FiniteSector both_motions(Index elements) {
  const FiniteSector in_plane = pressed(RingDirection::tangential, elements);
  const FiniteSector out_of_plane = pressed(RingDirection::axial, elements);
  FiniteSector sector = joined(in_plane, out_of_plane, 0);
  sector.contacts = {in_plane.contacts[0], in_plane.mass.rows() + out_of_plane.contacts[0]};
  sector.load(sector.contacts[0]) = 1;
  sector.load(sector.contacts[1]) = Complex(0, 1);
  return checked(sector);
}

/// As programs write matrices, with so many digits.
SparseMatrix written(SparseMatrix matrix, int digits) {
  for (Index i = 0; i < matrix.nonZeros(); ++i)
    matrix.valuePtr()[i] = std::stod(fmt::format("{:.{}e}", matrix.valuePtr()[i], digits - 1));
  return matrix;
}

SectorModes modes_of(const FiniteSector& sector, Index wave_number) {
  return sector_modes(sector, {wave_number, 24}, {50, 12000, 1e-10, light});
}

/// A case of two rings, both free, as `arcslip sector` writes it.
std::string free_pair(const TemporaryFolder& folder, const std::string& options) {
  const Outcome made = arcslip_program(fmt::format("sector ring {} -o '{}'", options, folder.path("pair")));
  REQUIRE(made.status == 0);
  return folder.path("pair/case.toml");
}

}  // namespace

TEST_CASE("A free ring has the response of its matrices, however fine it is", "[free]") {
  const auto direction = GENERATE(RingDirection::radial, RingDirection::tangential, RingDirection::axial);
  const Index elements = GENERATE(2, 20, 60);
  const Index n = GENERATE(0, 1, 2);
  CAPTURE(static_cast<int>(direction), elements, n);
  const SectorModes found = modes_of(pressed(direction, elements), n);
  // v^H K v cancels as (element/wave)^4, which leaves long double 1e-9 of 1440 elements, over a loss of 2e-4.
  CHECK(found.error < (elements > 20 ? 1e-6 : 1e-8));
  // Two elements to 15 degrees tilt with a stiffness of their own: the sine of the angle is no cubic.
  if (n == 0 || (n == 1 && elements > 2)) CHECK(found.free_squares.size() == 1);
  if (n == 2) CHECK(found.free_squares.empty());
}

TEST_CASE("A free ring moves as a whole with the mass of its sectors", "[free]") {
  const auto direction = GENERATE(RingDirection::tangential, RingDirection::axial);
  const Index elements = GENERATE(3, 40);  // all modes, and Lanczos'
  const SectorModes found = modes_of(pressed(direction, elements), 0);
  const SolidRing shape = ring(direction, elements);
  const double mass = shape.density * shape.width * shape.height * 2 * pi * shape.radius / 24;
  REQUIRE(found.free_squares.size() == 1);
  CHECK(found.frequencies[0] == 0);
  CHECK_THAT(std::norm(found.shapes(0, 0)) * 4 * pi * pi, WithinRel(1 / mass, 1e-8));
}

TEST_CASE("A window from near zero on costs a free ring no digits", "[free]") {
  SolidRing shape = ring(RingDirection::radial, 24);
  shape.sectors = 2;
  FiniteSector sector = ring_sector(shape);
  sector.contacts = {sector.contacts.front()};
  const SectorModes found = sector_modes(sector, {0, 2}, {0.01, 6000, 1e-10, light});
  CHECK(found.free_squares.size() == 1);
  CHECK(found.error < 1e-10);
}

TEST_CASE("Several motions may be free at once, and 14 digits are enough to tell them from elastic ones",
          "[free]") {
  const Index n = GENERATE(0, 1);
  const Index elements = GENERATE(6, 30);
  const int digits = GENERATE(14, 17);
  FiniteSector sector = both_motions(elements);
  sector.stiffness = written(sector.stiffness, digits);
  sector.mass = written(sector.mass, digits);
  const SectorModes found = modes_of(sector, n);
  CAPTURE(n, elements, digits);
  CHECK(found.free_squares.size() == 2);
  CHECK(found.frequencies[1] == 0);
  CHECK(found.frequencies[2] > 3000);
  CHECK(found.error < 1e-7);
}

TEST_CASE("Two free rings rub on each other by modes as by sparse solves", "[free]") {
  const auto options = GENERATE(values<std::string>(
      {"--contact tangential --wave-number 0 --from 50 --to 12000 --elements 20 --ring-elements 20",
       "--contact axial --wave-number 0 --from 400 --to 600 --contacts 2",
       "--contact radial --wave-number 1 --from 5000 --to 7000 --elements 20 --ring-elements 30"}));
  const TemporaryFolder folder;
  const std::string path = free_pair(folder, options);
  std::string text = read(path);
  text.erase(std::min(text.find("[study]"), text.size()));
  folder.write("pair/case.toml", text);
  const auto rows = [&](const std::string& how) {
    const Outcome run =
        arcslip_program(fmt::format("run '{}' --quiet {} -o '{}'", path, how, folder.path("out")));
    CHECK(run.err.empty());
    REQUIRE(run.status == 0);
    return read_csv(folder.path("out/branches.csv"));
  };
  const auto modes = rows("");
  const auto solves = rows("--set system.path=full");
  const auto ends = [](const auto& table) {
    std::vector<std::vector<std::string>> kept;
    for (const auto& row : table) {
      if (row[2] == "start" || row[2] == "end" || row[2] == "peak") kept.push_back(row);
    }
    return kept;
  };
  const auto expected = ends(solves);
  const auto found = ends(modes);
  REQUIRE(found.size() == expected.size());
  const auto column = std::find(modes[0].begin(), modes[0].end(), "R") - modes[0].begin();
  for (std::size_t i = 0; i < found.size(); ++i) {
    CHECK_THAT(std::stod(found[i][column]), WithinRel(std::stod(expected[i][column]), 1e-6));
  }
}

TEST_CASE("Free rings are damped by friction alone, and stay stable", "[free][numbers]") {
  const auto [n, direction] =
      GENERATE(table<int, std::string>({{0, "tangential"}, {0, "axial"}, {3, "axial"}, {4, "tangential"}}));
  const TemporaryFolder folder;
  const std::string path = free_pair(
      folder, fmt::format("--contact {} --wave-number {} --from 500 --to 520 --elements 2 --ring-elements 2",
                          direction, n));
  std::string text = read(path);
  const auto replace = [&](const std::string& from, const std::string& to) {
    for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size()))
      text.replace(at, from.size(), to);
  };
  replace("damping_kind = \"structural\"", "damping_kind = \"viscous\"\nreference_frequency = 4000.0");
  replace("[branch]", "[branch]\nstability = true");
  text.erase(text.find("for_each"));
  folder.write("pair/case.toml", text);
  const Outcome run = arcslip_program(fmt::format("run '{}' --quiet -o '{}'", path, folder.path("out")));
  CHECK(run.err.empty());
  REQUIRE(run.status == 0);
  const auto rows = read_csv(folder.path("out/branches.csv"));
  const auto column = std::find(rows[0].begin(), rows[0].end(), "unstable") - rows[0].begin();
  for (std::size_t i = 1; i < rows.size(); ++i) CHECK(rows[i][static_cast<std::size_t>(column)] == "0");
}

TEST_CASE("A nonlinear mode begins from one that moves the contact, not from both rings turning as one",
          "[free]") {
  const auto part = [](double mass, bool elastic) {
    std::vector<ContactMode> modes{{0, ContactVector::Constant(1, 1 / std::sqrt(mass)), 1}};
    if (elastic) modes.push_back({2, ContactVector::Constant(1, 1e-17), 0});  // decoupled but for rounding
    return ContactModes(1, std::move(modes), Loss{.viscous = 1e-4});
  };
  const problems::NonlinearMode mode(one_harmonic({part(3, true), part(1, false), {{5, 1}}}));
  const continuation::Guess guess = mode.guess(2, 0.1, 1);
  // Two masses on a spring, one against the other; w* = 2 pi eta is part of the shapes' unit.
  CHECK_THAT(guess.unknowns(problems::NonlinearMode::frequency),
             WithinRel(std::sqrt(5 * (1 + 1 / 3.0)), 1e-12));
}

TEST_CASE("The scale of a limit cycle's damping leaves out what moves without stiffness", "[free]") {
  FrictionSystem system{.base = ModalModel({{0, 0, 0}, {1, 0.5, 0}}, Loss{}),
                        .damper = ModalModel(std::vector<Mode>{}, Loss{}),
                        .contact_stiffness = 1,
                        .slip_per_preload = 1,
                        .base_loss_per_zeta = {.viscous = 2}};
  const problems::LimitCycle cycle(system);
  Vector unknowns(2);
  Vector parameters(2);
  cycle.scale(Eigen::Vector2d(1, 0), Eigen::Vector2d(0, 1), unknowns, parameters);
  CHECK_THAT(parameters(0), WithinRel(0.25 / pi, 1e-14));
}
