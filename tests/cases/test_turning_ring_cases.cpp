// Cases of whole rings whose sectors turn.

#include <map>

#include "arcslip/assembly/whole_ring.hpp"
#include "arcslip/cases/case_file.hpp"
#include "arcslip/problems/response/harmonic_response.hpp"
#include "case_runs.hpp"
#include "catch.hpp"
#include "mistakes.hpp"
#include "program.hpp"
#include "sector_files.hpp"
#include "turning_sectors.hpp"

using namespace arcslip;
using namespace arcslip::testing;

namespace {

/// The turning disk of 12 sectors, with these keys of [system] and what else there is.
std::string disk_case(const TemporaryFolder& folder, const std::string& keys, const std::string& ring,
                      const std::string& branch = "parameter = \"eta\"\nfrom = 100\nto = 330\n") {
  const FiniteSector disk = turning_disk();
  folder.write("g.mtx", write_matrix_market(disk.gyroscopic, MatrixSymmetry::general));
  folder.write("k2.mtx", write_matrix_market(disk.stiffness_speed2, MatrixSymmetry::symmetric));
  return "[system]\nmodel = \"sector\"\nsectors = 12\ncontact_stiffness = 3e5\npreload = 0.4\n" + keys +
         "\ndamping = { base = 1e-3, damper = 1e-3 }\n" +
         write_sector(folder, "base", disk,
                      "output = [6]\ngyroscopic = \"g.mtx\"\nstiffness_speed2 = \"k2.mtx\"") +
         ring + "[branch]\n" + branch;
}

TracedBranch traced(const TemporaryFolder& folder, const std::string& text) {
  const Case input = read_case(folder.write("case.toml", text));
  std::vector<TracedBranch> branches = trace(input.branches.front());
  REQUIRE(!branches.empty());
  CHECK(branches.front().branch.complete());
  return std::move(branches.front());
}

std::vector<std::string> symmetries_of(const TemporaryFolder& folder, const std::string& text) {
  const Case input = read_case(folder.write("case.toml", text));
  std::vector<std::string> names;
  for (const auto& one : build(input.branches.front().problem).problem->symmetries())
    names.push_back(one.name);
  return names;
}

const std::string uneven_disk = "[ring]\npreload = { scatter = 0.3, seed = 2 }\n";
const std::string cut_disk =
    "[[ring.cut]]\npart = \"base\"\nafter = [12]\ndofs = [1, 2, 1, 2]\n"
    "weights = [-0.2955, 0.9553, -0.2955, -0.9553]\nstiffness = 4e6\n";

}  // namespace

TEST_CASE("A ring of sectors that turn alike has the branch of one of them", "[ring section][rotation]") {
  const auto [keys, branch] = GENERATE(values<std::pair<std::string, std::string>>(
      {{"wave_number = -4\nspeed = 12", "parameter = \"eta\"\nfrom = 100\nto = 330\n"},
       {"engine_order = 4\npreload_speed2 = 2e-4", "parameter = \"speed\"\nfrom = 25\nto = 82\n"},
       {"wave_number = 3\nspeed = 5\nharmonics = 3",
        "parameter = \"speed\"\nfrom = -20\nto = 20\neta = 190\n"}}));
  const TemporaryFolder folder;
  const TracedBranch one = traced(folder, disk_case(folder, keys, "", branch));
  const TracedBranch whole = traced(folder, disk_case(folder, keys, "[ring]\n", branch));
  const bool over_speed = branch.find("eta = 190") != std::string::npos;
  for (const PointType type : {PointType::peak, PointType::regime_switch, PointType::end}) {
    const auto expected = points(one, type);
    const auto found = points(whole, type);
    CAPTURE(keys, static_cast<int>(type));
    REQUIRE(found.size() == expected.size());
    CHECK((over_speed || !expected.empty()));
    for (std::size_t i = 0; i < found.size(); ++i) {
      for (const char* name : {"R", "Y", "Y_6", "S", "Y_max"}) {
        const char* own = std::string(name) == "Y_max" ? "Y" : name;
        CHECK_THAT(value(whole, found[i], name), WithinRel(value(one, expected[i], own), 1e-7));
      }
      CHECK_THAT(found[i].parameters(0), WithinRel(expected[i].parameters(0), 1e-8));
      const bool is_forward = keys.find("wave_number = 3") != std::string::npos;
      const double Y = value(whole, found[i], "Y");
      CHECK_THAT(value(whole, found[i], is_forward ? "Y_wave_3" : "Y_back_4"), WithinRel(Y, 1e-9));
      CHECK(value(whole, found[i], is_forward ? "Y_back_3" : "Y_wave_4") < 1e-9 * Y);
    }
  }
}

TEST_CASE("Along a continued speed whole rings pass the responses at each, through rest and back",
          "[ring section][rotation]") {
  const TemporaryFolder folder;
  const std::string more = GENERATE("", "\nharmonics = 3");
  const std::string branch =
      "parameter = \"speed\"\nfrom = -20\nto = 20\neta = 190\n"
      "[continuation]\nstop_at = [-11, 0, 17]\n";
  const TracedBranch found =
      traced(folder, disk_case(folder, "wave_number = 3\nspeed = 5" + more, uneven_disk + cut_disk, branch));
  const auto stops = points(found, PointType::user);
  REQUIRE(stops.size() == 3);
  for (const BranchPoint& point : stops) {
    const double speed = value(found, point, "speed");
    const TracedBranch there =
        traced(folder, disk_case(folder, fmt::format("wave_number = 3\nspeed = {}", speed) + more,
                                 uneven_disk + cut_disk, "parameter = \"eta\"\nfrom = 190\nto = 192\n"));
    CAPTURE(speed);
    const BranchPoint& start = there.branch.points.front();
    for (const char* name : {"R", "Y", "Y_max", "Y_min", "Y_6", "Y_wave_3", "Y_back_3", "energy_contacts"})
      CHECK_THAT(value(found, point, name), WithinRel(value(there, start, name), 1e-8));
  }
  const Outcome check = arcslip_program("check --derivatives '" + folder.path("case.toml") + "'");
  CAPTURE(check.out, check.err);
  CHECK(check.status == 0);
}

TEST_CASE("No needle of any wave of a ring that turns is passed", "[ring section][rotation]") {
  const TemporaryFolder folder;
  std::string text = disk_case(folder, "wave_number = 1\nspeed = 12", "[ring]\nload = \"point\"\n",
                               "parameter = \"eta\"\nfrom = 100\nto = 330\n");
  text = replaced(replaced(text, "base = 1e-3, damper = 1e-3", "base = 1e-6, damper = 1e-6"), "preload = 0.4",
                  "preload = 1e9");  // stuck everywhere
  const Case input = read_case(folder.write("case.toml", text));
  const SystemParameters& whole = input.branches.front().problem.system;
  const TracedBranch branch = traced(folder, text);
  const auto peaks = points(branch, PointType::peak);
  SystemParameters one = structures_of(whole).whole()->one_sector(whole);
  std::vector<double> needles;
  for (Index n = -5; n <= 6; ++n) {
    one.wave_number = n;
    const ContactSystem wave = build_wave(one);
    for (const JoinedMode& mode : joined_modes({&wave.base, &wave.damper}, contact_springs(wave.contacts))) {
      if (mode.frequency > 100 && mode.frequency < 330) needles.push_back(mode.frequency);
    }
  }
  CHECK(needles.size() >= 12);
  for (const double eta : needles) {
    CAPTURE(eta);
    CHECK(std::any_of(peaks.begin(), peaks.end(), [&](const BranchPoint& point) {
      return std::abs(point.parameters(0) / eta - 1) < 1e-7;
    }));
  }
}

TEST_CASE("A ring that turns has no mirror, also where its speed is continued from rest",
          "[ring symmetry][rotation]") {
  const TemporaryFolder folder;
  const std::string ring = "[ring]\nload = \"standing\"\n";
  const std::vector<std::string> shift{"shift by 6 sectors, half a period later"};
  const std::vector<std::string> at_rest =
      symmetries_of(folder, disk_case(folder, "wave_number = 1\nspeed = 0.0", ring));
  CHECK(std::find(at_rest.begin(), at_rest.end(), "mirror at sector 1") != at_rest.end());
  CHECK(symmetries_of(folder, disk_case(folder, "wave_number = 1\nspeed = 9.0", ring)) == shift);
  const std::string speed = "parameter = \"speed\"\nfrom = 0\nto = 20\neta = 190\n";
  CHECK(symmetries_of(folder, disk_case(folder, "wave_number = 1", ring, speed)) == shift);
}

TEST_CASE("The amplification of a ring that turns is over that of the equal one that does",
          "[ring section][rotation]") {
  const TemporaryFolder folder;
  const std::string keys = "engine_order = 4";
  const std::string branch = "parameter = \"eta\"\nfrom = 100\nto = 220\nextrema_of = [\"Y_max\"]\n";
  const auto highest = [&](const std::string& ring, const std::string& name) {
    const TracedBranch found = traced(folder, disk_case(folder, keys, ring, branch));
    double most = 0;
    for (const BranchPoint& point : found.branch.points) most = std::max(most, value(found, point, name));
    return most;
  };
  const double own = highest(uneven_disk + cut_disk, "Y_max");
  const double equal = highest("[ring]\n", "Y_max");
  CHECK(std::abs(own / equal - 1) > 1e-3);
  CHECK_THAT(highest(uneven_disk + "amplification = true\n" + cut_disk, "amplification"),
             WithinRel(own / equal, 1e-8));
}

// All dofs of disk and ring in one balance of the first harmonic, by an independent solver.
TEST_CASE("The case of a split ring in a turning disk has the amplitudes that it says",
          "[ring section][rotation][numbers]") {
  const Run run("turning_ring", {"continuation.stop_at=[50.0, 55.0, 58.0]"});
  REQUIRE(run.traced.size() == 1);
  const TracedBranch& found = run.traced[0];
  CHECK(found.branch.complete());
  const auto stops = points(found, PointType::user);
  REQUIRE(stops.size() == 3);
  struct Known {
    double highest;
    double lowest;
    double tip;
    int slipping;
  };
  const Known known[] = {{1.56117582e-06, 1.37300305e-06, 1.12390163e-05, 8},
                         {1.10871408e-05, 1.05471936e-05, 7.84270644e-05, 24},
                         {2.4068006e-06, 1.38352198e-06, 1.59391642e-05, 9}};
  for (std::size_t i = 0; i < 3; ++i) {
    CHECK_THAT(value(found, stops[i], "Y_max"), WithinRel(known[i].highest, 1e-7));
    CHECK_THAT(value(found, stops[i], "Y_min"), WithinRel(known[i].lowest, 1e-7));
    CHECK(value(found, stops[i], "Y_back_3") > 5 * value(found, stops[i], "Y_wave_3"));
    CHECK_THAT(value(found, stops[i], "Y_6_max"), WithinRel(known[i].tip, 1e-7));
    CHECK(std::lround(24 * value(found, stops[i], "slipping")) == known[i].slipping);
  }
}

TEST_CASE("What is not calculated of whole rings that turn is refused in one line",
          "[ring section][rotation]") {
  const TemporaryFolder folder;
  const std::string mistuned =
      "[[ring.mistuning]]\npart = \"base\"\ndofs = [6]\nstiffness = 1e5\n"
      "factors = { scatter = 0.1 }\n";
  const std::string text = disk_case(folder, "wave_number = 3\nspeed = 8", uneven_disk + cut_disk + mistuned);
  CHECK_NOTHROW(read_case(folder.write("case.toml", text)));
  for (const Mistake& mistake : std::vector<Mistake>{
           {"from = 100", "from = 100\nstability = true", ":", "branch.stability", "not of sectors that turn",
            ""},
           {"stiffness = 1e5\n", "mass = 0.1\n", ":", "mass", "not on dof 6, which Coriolis' forces act on",
            ""},
           {"dofs = [1, 2, 1, 2]\nweights = [-0.2955, 0.9553, -0.2955, -0.9553]", "dofs = [1, 2, 1, 2]", ":",
            "dofs", "expected two dofs", "got 4"},
           {"-0.2955, -0.9553]", "-0.2955]", ":", "weights", "4 numbers, one for each of `dofs`", "got 3"},
           {"[-0.2955, 0.9553, ", "[0, 0, ", ":", "weights", "of both sectors that are not 0", ""},
           {"wave_number = 3\nspeed = 8", "wave_number = 3\nspeed = 8\npath = \"full\"", ":", "ring",
            "outputs of a structure that is solved for", ""}}) {
    check_message(
        error_of([&] { read_case(folder.write("case.toml", replaced(text, mistake.from, mistake.to))); }),
        mistake);
  }
  for (const std::string load : {"standing", "point"}) {
    const std::string path =
        folder.write("case.toml", disk_case(folder, "engine_order = 3", "[ring]\nload = \"" + load + "\"\n"));
    CHECK_THAT(error_of([&] { read_case(path); }),
               ContainsSubstring("ring.load: expected \"travelling\" or a list beside engine_order") &&
                   ContainsSubstring("got \"" + load + "\""));
  }
}
