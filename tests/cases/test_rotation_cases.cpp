// Cases whose sectors turn.

#include <cmath>
#include <map>

#include "arcslip/assembly/harmonic_system.hpp"
#include "arcslip/cases/case_file.hpp"
#include "arcslip/continuation/problem/derivative_check.hpp"
#include "arcslip/problems/response/power_balance.hpp"
#include "case_runs.hpp"
#include "catch.hpp"
#include "mistakes.hpp"
#include "paper_sectors.hpp"
#include "program.hpp"
#include "sector_files.hpp"
#include "turning_sectors.hpp"

using namespace arcslip;
using namespace arcslip::testing;

namespace {

/// [system] of the turning disk, whose contact rubs on what is held or, with `ring`, on the lumped ring.
std::string turning_system(const TemporaryFolder& folder, const std::string& keys, bool ring = false) {
  const FiniteSector disk = turning_disk();
  folder.write("g.mtx", write_matrix_market(disk.gyroscopic, MatrixSymmetry::general));
  folder.write("k2.mtx", write_matrix_market(disk.stiffness_speed2, MatrixSymmetry::symmetric));
  std::string text = "[system]\nmodel = \"sector\"\nsectors = 24\ncontact_stiffness = 3e5\npreload = 0.4\n" +
                     keys + "\ndamping = { base = 1e-3, damper = 1e-3 }\n" +
                     write_sector(folder, "base", disk,
                                  "output = [5, 6]\ngyroscopic = \"g.mtx\"\nstiffness_speed2 = \"k2.mtx\"");
  if (ring) text += write_sector(folder, "damper", lumped_ring(), "output = [1]");
  return text;
}

std::string eta_branch(const std::string& more = "") {
  return "[branch]\nparameter = \"eta\"\nfrom = 100\nto = 330\n[continuation]\nstop_at = [135, 190, 230, "
         "260]\n" +
         more;
}

/// The numbers of all points of a type, by the names of their columns.
using NamedRow = std::map<std::string, double>;
std::vector<NamedRow> rows_named(const std::vector<std::vector<std::string>>& table,
                                 const std::string& type) {
  std::vector<NamedRow> all;
  for (std::size_t i = 1; i < table.size(); ++i) {
    if (table[i][2] != type) continue;
    NamedRow& row = all.emplace_back();
    for (std::size_t k = 4; k < table[i].size(); ++k)
      row[table.front()[k]] = std::strtod(table[i][k].c_str(), nullptr);
  }
  return all;
}

std::vector<NamedRow> rows_of(const TemporaryFolder& folder, const std::string& text,
                              const std::string& type) {
  return rows_named(branches_csv(read_case(folder.write("case.toml", text))), type);
}

void check_same(const NamedRow& found, const NamedRow& expected, double tolerance) {
  for (const auto& [name, value] : expected) {
    if (name == "arclength" || name == "iterations" || name == "residual" || !found.contains(name)) continue;
    CAPTURE(name);
    CHECK_THAT(found.at(name), WithinRel(value, tolerance) || WithinAbs(value, 1e-12 * tolerance));
  }
}

}  // namespace

TEST_CASE("At speed 0 all columns are those of the sectors at rest, bit for bit", "[rotation]") {
  const std::string path = GENERATE("reduced", "full");
  const bool ring = GENERATE(false, true);
  const TemporaryFolder folder;
  const std::string system =
      turning_system(folder, "wave_number = 3\nharmonics = 3\npath = \"" + path + "\"", ring) + eta_branch();
  const std::string at_rest =
      replaced(replaced(system, "gyroscopic = \"g.mtx\"\n", ""), "stiffness_speed2 = \"k2.mtx\"\n", "");
  const std::string still = replaced(system, "wave_number = 3\n", "wave_number = 3\nspeed = 0.0\n");
  const auto table = [&](const std::string& text) {
    return branches_csv(read_case(folder.write("case.toml", text)));
  };
  const auto expected = table(at_rest);
  CHECK(expected.size() > 50);
  CHECK(table(still) == expected);
}

TEST_CASE("Waves that run against the rotation differ from those that run with it, at rest they do not",
          "[rotation]") {
  const TemporaryFolder folder;
  const auto peaks = [&](const std::string& keys) {
    return rows_of(folder, turning_system(folder, keys) + eta_branch(), "peak");
  };
  const auto with = peaks("wave_number = 3\nspeed = 8");
  const auto against = peaks("wave_number = -3\nspeed = 8");
  const auto turned = peaks("wave_number = -3\nspeed = -8");
  const auto rest = peaks("wave_number = 3");
  const auto back = peaks("wave_number = -3");
  REQUIRE((with.size() == turned.size() && rest.size() == back.size()));
  REQUIRE((!with.empty() && !against.empty()));
  CHECK(std::abs(with[0].at("eta") / against[0].at("eta") - 1) > 1e-3);
  // Turned round, both ways of counting are one: the radial load and contact are alike from both sides.
  for (std::size_t i = 0; i < with.size(); ++i)
    CHECK_THAT(turned[i].at("Y"), WithinRel(with[i].at("Y"), 1e-8));
  for (std::size_t i = 0; i < rest.size(); ++i) {
    CHECK_THAT(back[i].at("eta"), WithinRel(rest[i].at("eta"), 1e-9));
    CHECK_THAT(back[i].at("Y"), WithinRel(rest[i].at("Y"), 1e-9));
  }
}

TEST_CASE("Modes that rotation couples give every column that sparse solves give", "[rotation]") {
  const std::string rotation =
      GENERATE("wave_number = -3\nspeed = 8", "wave_number = 5\nspeed = 20", "engine_order = 5",
               "wave_number = 12\nspeed = 8", "wave_number = 0\nspeed = 8");
  const std::string more = GENERATE("", "\nharmonics = 3");
  const TemporaryFolder folder;
  const std::string text = turning_system(folder, rotation + more, true) + eta_branch();
  const std::string full = replaced(text, "model = \"sector\"\n", "model = \"sector\"\npath = \"full\"\n");
  for (const std::string type : {"user", "peak"}) {
    const auto found = rows_of(folder, full, type);
    const auto expected = rows_of(folder, text, type);
    REQUIRE(found.size() == expected.size());
    CHECK((type == "peak" || found.size() == 4));
    for (std::size_t i = 0; i < found.size(); ++i) {
      CAPTURE(rotation, more, type, i);
      if (type == "user") check_same(found[i], expected[i], 1e-7);
      CHECK_THAT(found[i].at("Y"), WithinRel(expected[i].at("Y"), 1e-8));
    }
  }
}

TEST_CASE("Coriolis forces do no work: what the load gives friction and damping take", "[rotation]") {
  const std::string path = GENERATE("reduced", "full");
  const std::string rotation = GENERATE("wave_number = -3\nspeed = 25", "engine_order = 7");
  const TemporaryFolder folder;
  const Case input = read_case(folder.write(
      "case.toml",
      turning_system(folder, rotation + "\nharmonics = 3\npath = \"" + path + "\"", true) + eta_branch()));
  const auto traced = trace(input.branches.front());
  const problems::HarmonicResponse problem(build_harmonic_system(input.branches.front().problem.system));
  double most = 0;
  for (const auto& point : traced.front().branch.points) {
    const auto works = problems::power_balance(problem, point.unknowns, point.parameters, point.regime);
    CAPTURE(path, rotation, point.parameters(0));
    CHECK(works.error() < 1e-7);  // the residual 1e-10 over the damping ratio 1e-3
    CHECK(works.base > 0);
    most = std::max(most, works.friction / works.input);
    CHECK(problems::motion_error(problem, point.unknowns, point.parameters, point.regime) < 1e-7);
  }
  CHECK(most > 0.1);
}

TEST_CASE("An engine order is the wave that it moves as, at the speed that it has there", "[rotation]") {
  struct Order {
    int m, n;
  };
  // Of 24 sectors: below and above N/2, at N/2, N, and beside N on both sides.
  const auto order =
      GENERATE(values<Order>({{3, -3}, {27, -3}, {21, 3}, {45, 3}, {12, 12}, {24, 0}, {13, 11}}));
  const TemporaryFolder folder;
  const auto along = rows_of(
      folder, turning_system(folder, fmt::format("engine_order = {}", order.m)) + eta_branch(), "user");
  REQUIRE(along.size() == 4);
  for (const NamedRow& row : along) {
    const double eta = row.at("eta");
    CAPTURE(order.m, eta);
    CHECK_THAT(row.at("speed"), WithinRel(eta / order.m, 1e-15));
    const std::string keys = fmt::format("wave_number = {}\nspeed = {:.17g}", order.n, eta / order.m);
    const auto there =
        rows_of(folder,
                turning_system(folder, keys) +
                    fmt::format("[branch]\nparameter = \"eta\"\nfrom = {0:.17g}\nto = 330\n", eta),
                "start");
    REQUIRE(there.size() == 1);
    for (const char* name : {"R", "Y", "Y_5", "Y_6", "psi", "S"})
      CHECK_THAT(row.at(name), WithinRel(there[0].at(name), 1e-8));
  }
}

TEST_CASE("With a speed as parameter frequency, wave, stiffness and preload follow the engine order",
          "[rotation]") {
  const TemporaryFolder folder;
  const std::string keys = "engine_order = 5\npreload_speed2 = 2e-4";
  const std::string over_eta = turning_system(folder, keys) + eta_branch();
  const std::string over_speed =
      turning_system(folder, keys) +
      "[branch]\nparameter = \"speed\"\nfrom = 20\nto = 66\n[continuation]\nstop_at = [27, 38, 46, 52]\n";
  for (const std::string type : {"user", "peak", "switch"}) {
    const auto expected = rows_of(folder, over_eta, type);
    const auto found = rows_of(folder, over_speed, type);
    REQUIRE(!expected.empty());
    REQUIRE(found.size() == expected.size());
    for (std::size_t i = 0; i < found.size(); ++i) {
      check_same(found[i], expected[i], type == "user" ? 1e-12 : 1e-7);
      const double speed = found[i].at("speed");
      CHECK_THAT(found[i].at("eta"), WithinRel(5 * speed, 1e-14));
      CHECK_THAT(found[i].at("S"), WithinRel((0.4 + 2e-4 * speed * speed) / 3e5, 1e-13));
    }
  }
}

TEST_CASE("A speed that is continued passes the responses at each speed, through rest and back",
          "[rotation]") {
  const std::string path = GENERATE("reduced", "full");
  const std::string more = GENERATE("", "\nharmonics = 3");
  const TemporaryFolder folder;
  const std::string keys = "wave_number = 3\npath = \"" + path + "\"" + more;
  const std::string text = turning_system(folder, keys + "\nspeed = 5", true) +
                           "[branch]\nparameter = \"speed\"\nfrom = -20\nto = 20\neta = 190\n"
                           "[continuation]\nstop_at = [-11, 0, 4, 17]\n";
  const Case input = read_case(folder.write("case.toml", text));
  const auto found = rows_named(branches_csv(input), "user");
  REQUIRE(found.size() == 4);
  for (const NamedRow& row : found) {
    const std::string there =
        turning_system(folder, keys + fmt::format("\nspeed = {}", row.at("speed")), true) +
        "[branch]\nparameter = \"eta\"\nfrom = 190\nto = 200\n";
    const auto expected = rows_of(folder, there, "start");
    REQUIRE(expected.size() == 1);
    CAPTURE(path, row.at("speed"));
    for (const char* name : {"R", "Y", "U", "Y_5", "psi"})
      CHECK_THAT(row.at(name), WithinRel(expected[0].at(name), 1e-8));
  }
  const Outcome check = arcslip_program("check --derivatives '" + folder.path("case.toml") + "'");
  CAPTURE(check.out, check.err);
  CHECK(check.status == 0);
}

TEST_CASE("Peaks over speed are a curve, which passes the peaks of single speeds", "[rotation]") {
  const TemporaryFolder folder;
  const std::string text =
      turning_system(folder, "wave_number = -3\nspeed = 0.0") +
      "[branch]\ncurve = \"peak\"\nparameters = [\"eta\", \"speed\"]\nfrom = 0\nto = 16\n"
      "window = [100, 330]\n[continuation]\nstop_at = [6, 12]\n";
  const auto found = rows_of(folder, text, "user");
  REQUIRE(found.size() >= 2);
  for (const NamedRow& row : found) {
    const auto single = rows_of(
        folder,
        turning_system(folder, fmt::format("wave_number = -3\nspeed = {}", row.at("speed"))) + eta_branch(),
        "peak");
    const auto nearest = std::min_element(single.begin(), single.end(), [&](const auto& a, const auto& b) {
      return std::abs(a.at("eta") - row.at("eta")) < std::abs(b.at("eta") - row.at("eta"));
    });
    REQUIRE(nearest != single.end());
    CAPTURE(row.at("speed"));
    CHECK_THAT(row.at("eta"), WithinRel(nearest->at("eta"), 1e-7));
    CHECK_THAT(row.at("Y"), WithinRel(nearest->at("Y"), 1e-8));
  }
}

TEST_CASE("No needle of a structure that turns is passed, contacts free or stuck", "[rotation]") {
  const std::string path = GENERATE("reduced", "full");
  const std::string keys =
      GENERATE("wave_number = -4\nspeed = 12", "wave_number = 4\nspeed = 12", "engine_order = 4");
  const TemporaryFolder folder;
  std::string text = turning_system(folder, keys + "\npath = \"" + path + "\"", true) +
                     "[branch]\nparameter = \"eta\"\nfrom = 20\nto = 900\n";
  text = replaced(replaced(text, "base = 1e-3, damper = 1e-3", "base = 1e-7, damper = 1e-7"), "preload = 0.4",
                  "preload = 1e9");  // stuck everywhere
  const Case input = read_case(folder.write("case.toml", text));
  const auto peaks = rows_named(branches_csv(input), "peak");
  const ContactSystem wave = build_wave(input.branches.front().problem.system);
  std::size_t needles = 0;
  for (const JoinedMode& mode : joined_modes({&wave.base, &wave.damper}, contact_springs(wave.contacts))) {
    if (!(mode.frequency > 20 && mode.frequency < 900)) continue;
    ++needles;
    CAPTURE(path, keys, mode.frequency);
    CHECK(std::any_of(peaks.begin(), peaks.end(), [&](const NamedRow& row) {
      return std::abs(row.at("eta") / mode.frequency - 1) < 1e-9;  // the square of the damping, and rounding
    }));
    CHECK_THAT(mode.damping,
               WithinRel(1e-7, 0.6));  // of a mode that moves with speed, no more than of that order
  }
  CHECK(needles >= 4);
}

TEST_CASE("What is not calculated of sectors that turn is refused in one line", "[rotation]") {
  const TemporaryFolder folder;
  const std::string text = turning_system(folder, "wave_number = 3\nspeed = 8", true) + eta_branch();
  const auto mistake = GENERATE(values<Mistake>({
      {"wave_number = 3", "wave_number = 26", ":", "system.wave_number",
       "-sectors/2 = -12 and <= sectors/2 = 12", "26: on 24 sectors 26 waves move as 2"},
      {"wave_number = 3", "wave_number = -13", ":", "system.wave_number", "<= sectors/2 = 12",
       "-13 waves move as 11"},
      {"wave_number = 3", "engine_order = 3\nwave_number = 3", ":", "system.wave_number",
       "not beside engine_order", ""},
      {"wave_number = 3", "engine_order = 3", ":", "system.speed", "not beside engine_order", ""},
      {"wave_number = 3\nspeed = 8", "engine_order = 0", ":", "system.engine_order", ">= 1", "0"},
      {"speed = 8", "speed = 8\npreload_speed2 = 1.0", ":", "system.preload_speed2",
       "only beside engine_order", ""},
      {"gyroscopic = \"g.mtx\"\nstiffness_speed2 = \"k2.mtx\"", "", ":", "system.speed", "nothing feels it",
       ""},
      {"gyroscopic = \"g.mtx\"", "gyroscopic = \"k2.mtx\"", ":", "system.base", "not skew-symmetric", ""},
      {"from = 100", "from = 100\nstability = true", ":", "branch.stability", "not of sectors that turn", ""},
      {"wave_number = 3\nspeed = 8", "engine_order = 3\neven_harmonics = true", ":", "system.engine_order",
       "the mean, which even harmonics call for, is not balanced", ""},
  }));
  CHECK_NOTHROW(read_case(folder.write("case.toml", text)));
  const std::string path = folder.write("case.toml", replaced(text, mistake.from, mistake.to));
  check_message(error_of([&] { read_case(path); }), mistake);
}

TEST_CASE("Vibration without load is not calculated of sectors that turn", "[rotation]") {
  const TemporaryFolder folder;
  const std::string branch = GENERATE("response = \"nonlinear_mode\"\nparameter = \"R\"\neta = 150\n",
                                      "response = \"limit_cycle\"\nparameter = \"P\"\n");
  const std::string path = folder.write(
      "case.toml", turning_system(folder, "wave_number = 3\nspeed = 8\nreduction_window = [100, 330]") +
                       "[branch]\n" + branch + "from = 1\nto = 2\n");
  const std::string message = error_of([&] { read_case(path); });
  CHECK_THAT(message, ContainsSubstring("system.speed: only of forced and one-way responses"));
}
