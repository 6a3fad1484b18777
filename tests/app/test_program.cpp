// The program as a user meets it: commands, files, exit statuses.

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <vector>

#include "background.hpp"
#include "catch.hpp"
#include "program.hpp"

using namespace arcslip::testing;

TEST_CASE("check and run print the groups of a system in SI units, and run its special points in these") {
  const TemporaryFolder folder;
  const std::string units =
      "eta = 1: 56.2442 Hz, P = 1: 34879.2 N/m, Y = 1: 0.816814 m; resonances alone: base 2295.23 Hz, damper "
      "506.198 Hz\n";
  const Outcome checked = arcslip_program("check " + case_named("rotor_ring"));
  CHECK(checked.status == 0);
  CHECK_THAT(checked.out, ContainsSubstring("preload_per_length = 300") && ContainsSubstring(units) &&
                              ContainsSubstring("K_FD = 1.6175e+10, F = 0.00955679, P = 0.00860111"));
  const Outcome run = arcslip_program("run " + case_named("rotor_ring") + " -o " + folder.path("r"));
  CHECK(run.status == 0);
  CHECK_THAT(run.out, ContainsSubstring(units) && ContainsSubstring("frequency_Hz             Y_m") &&
                          ContainsSubstring("2283.16277  4.57696756e-06"));
  const std::vector<std::string> header = read_csv(folder.path("r/branches.csv")).front();
  const std::vector<std::string> last(header.end() - 8, header.end());
  CHECK(last == std::vector<std::string>{"frequency_Hz", "preload_N_per_m", "R_m", "S_m", "Y_m", "U_m",
                                         "dissipated_J", "T_max_N"});
}

TEST_CASE("curves.csv has the points of branches.csv, more of the curve in between, and no verdicts") {
  const TemporaryFolder folder;
  const std::string stability = case_named("stability");
  REQUIRE(arcslip_program("run " + stability + " --quiet -o " + folder.path("r")).status == 0);
  const auto branches = read_csv(folder.path("r/branches.csv"));
  const auto curves = read_csv(folder.path("r/curves.csv"));
  REQUIRE(curves.front() == branches.front());
  CHECK(curves.size() > 2 * branches.size());
  const auto place = [&](const char* name) {
    return std::find(curves[0].begin(), curves[0].end(), name) - curves[0].begin();
  };
  const auto number = [](const auto& row, std::ptrdiff_t i) {
    return std::stod(row[static_cast<std::size_t>(i)]);
  };
  std::size_t next = 1;
  for (std::size_t i = 1; i < curves.size(); ++i) {
    CHECK(std::isfinite(number(curves[i], place("Y"))));
    CHECK(std::isnan(number(curves[i], place("growth"))));
    CHECK(number(curves[i], place("unstable")) >= 0);
    if (std::isnan(number(curves[i], place("residual")))) continue;
    REQUIRE(next < branches.size());
    CHECK(curves[i][2] == branches[next][2]);
    CHECK_THAT(number(curves[i], place("Y")), WithinRel(number(branches[next], place("Y")), 1e-9));
    ++next;
  }
  CHECK(next == branches.size());
}

TEST_CASE("run writes both files whole, prints the special points and nothing on stderr") {
  const TemporaryFolder folder;
  const Outcome outcome = arcslip_program("run " + figure_8_case + " -o " + folder.path("r"));
  CHECK(outcome.status == 0);
  CHECK(outcome.err.empty());
  CHECK_THAT(outcome.out, ContainsSubstring("preload = 0.1") && ContainsSubstring("3.841129"));
  CHECK(names_in(folder.path("r")) == std::set<std::string>{"branches.csv", "curves.csv", "summary.json"});

  const auto rows = read_csv(folder.path("r/branches.csv"));
  const std::vector<std::string> header = {"branch", "point", "type",      "regime",     "eta",
                                           "P",      "R",     "S",         "R_over_S",   "Y",
                                           "U",      "beta",  "alpha",     "psi",        "dissipated",
                                           "T_max",  "slip",  "arclength", "iterations", "residual"};
  REQUIRE(rows.front() == header);
  std::set<std::string> types;
  for (std::size_t i = 1; i < rows.size(); ++i) {
    REQUIRE(rows[i].size() == header.size());
    types.insert(rows[i][2]);
    CHECK(std::stod(rows[i].back()) <= 1e-9);
    if (rows[i][2] == "switch") CHECK_THAT(std::stod(rows[i][8]), WithinAbs(1, 1e-10));
  }
  CHECK(types == std::set<std::string>{"start", "regular", "switch", "peak", "trough", "end"});

  const auto summary = nlohmann::json::parse(read(folder.path("r/summary.json")));
  CHECK(summary["title"] == "Two beams, figure 8");
  CHECK(summary["case"]["system"]["mass_ratio"] == 5.0);
  REQUIRE(summary["branches"].size() == 5);
  std::size_t points = 0;
  for (const auto& branch : summary["branches"]) {
    CHECK(branch["stop"] == "reached_end");
    points += branch["points"].get<std::size_t>();
  }
  CHECK(points == rows.size() - 1);
  const auto& second = summary["branches"][1];
  CHECK(second["values"]["preload"] == 1.0);
  CHECK_THAT(second["peak"]["eta"].get<double>(), WithinRel(3.841129, 1e-7));
  CHECK_THAT(second["peak"]["Y"].get<double>(), WithinRel(0.00718851766, 1e-8));
}

TEST_CASE("Rows of a branch start and end exactly on the values asked for") {
  const TemporaryFolder folder;
  const Outcome outcome = arcslip_program("run " + figure_8_case + " --quiet -o " + folder.path("r") +
                                          " --set continuation.stop_at=[3.9,4.1] --set branch.from=120.0 "
                                          "--set branch.to=0.7");
  CHECK(outcome.status == 0);
  CHECK(outcome.out.empty());
  int users = 0;
  for (const auto& row : read_csv(folder.path("r/branches.csv"))) {
    if (row[2] == "start") CHECK(std::stod(row[4]) == 120.0);
    if (row[2] == "end") CHECK(std::stod(row[4]) == 0.7);
    if (row[2] == "user") users += static_cast<int>(std::stod(row[4]) == 3.9 || std::stod(row[4]) == 4.1);
  }
  CHECK(users == 10);
}

TEST_CASE("The results of two runs are the same to the last digit") {
  const TemporaryFolder folder;
  arcslip_program("run " + figure_8_case + " --quiet -o " + folder.path("a"));
  arcslip_program("run " + figure_8_case + " --quiet -o " + folder.path("b"));
  CHECK(read(folder.path("a/branches.csv")) == read(folder.path("b/branches.csv")));
}

TEST_CASE("Wrong input has status 1 and one line, and leaves nothing behind") {
  const TemporaryFolder folder;
  const std::string bad =
      folder.write("bad.toml", "[system]\nmodel = 3\n[branch]\nparameter = \"eta\"\nfrom = 1\nto = 2\n");
  const std::string no_toml = folder.write("no.toml", "\x01\x02 this is no TOML");
  for (const std::string& path : {bad, no_toml, folder.path("missing.toml"), std::string("/")}) {
    const Outcome outcome = arcslip_program("run " + path + " -o " + folder.path("r"));
    INFO(outcome.err);
    CHECK(outcome.status == 1);
    CHECK(is_one_line(outcome.err));
    CHECK_THAT(outcome.err, ContainsSubstring(path));
    CHECK_FALSE(std::filesystem::exists(folder.path("r")));
  }
}

TEST_CASE("A wrong command line has status 2 and one line") {
  for (const std::string arguments :
       {"", "rum case.toml", "run", "run a.toml b.toml", "run --sett a=1 case.toml", "plot"}) {
    const Outcome outcome = arcslip_program(arguments);
    INFO(outcome.err);
    CHECK(outcome.status == 2);
    CHECK(is_one_line(outcome.err));
  }
}

TEST_CASE("check says what would run, and refuses what run would refuse") {
  const Outcome outcome = arcslip_program("check " + figure_8_case);
  CHECK(outcome.status == 0);
  CHECK_THAT(outcome.out,
             ContainsSubstring("branch 4: preload = 50") && ContainsSubstring("eta from 0.5 to 120"));
  CHECK(arcslip_program("check " + figure_8_case + " --set system.elements=1").status == 1);
}

TEST_CASE("A folder that cannot be written has status 4 and one line") {
  const TemporaryFolder folder;
  folder.write("file", "");
  const Outcome blocked = arcslip_program("run " + figure_8_case + " -o " + folder.path("file/below"));
  CHECK(blocked.status == 4);
  CHECK(is_one_line(blocked.err));
  const Outcome taken = arcslip_program("run " + figure_8_case + " -o " + folder.path("file"));
  CHECK(taken.status == 4);
  CHECK(is_one_line(taken.err));
}

TEST_CASE("A disk that fills up has status 4 and leaves no partial file, nor harms an older result") {
  const TemporaryFolder folder;
  REQUIRE(arcslip_program("run " + figure_8_case + " --quiet -o " + folder.path("r")).status == 0);
  const std::string before = read(folder.path("r/branches.csv"));
  // A limit on the size of files stands for the full disk: writes fail in the same place.
  const Outcome outcome =
      shell("ulimit -f 100; '" + program + "' run " + figure_8_case + " -o " + folder.path("r"));
  CHECK(outcome.status == 4);
  CHECK(is_one_line(outcome.err));
  CHECK_THAT(outcome.err, ContainsSubstring("branches.csv: cannot be written"));
  CHECK(names_in(folder.path("r")) == std::set<std::string>{"branches.csv", "curves.csv", "summary.json"});
  CHECK(read(folder.path("r/branches.csv")) == before);
  const Outcome full =
      shell("'" + program + "' run " + figure_8_case + " -o " + folder.path("s") + " >/dev/full");
  CHECK(full.status == 4);
  CHECK(names_in(folder.path("s")) == std::set<std::string>{"branches.csv", "curves.csv", "summary.json"});
}

TEST_CASE("A reader that has seen enough of the table is no error") {
  const TemporaryFolder folder;
  const Outcome outcome =
      shell("'" + program + "' run " + figure_8_case + " -o " + folder.path("r") + " | true");
  CHECK(outcome.err.empty());
  CHECK(names_in(folder.path("r")) == std::set<std::string>{"branches.csv", "curves.csv", "summary.json"});
}

TEST_CASE("A branch that cannot be finished has status 3, its reason, and what was traced") {
  const TemporaryFolder folder;
  const Outcome outcome = arcslip_program("run " + figure_8_case + " --quiet -o " + folder.path("r") +
                                          " --set continuation.max_points=50");
  CHECK(outcome.status == 3);
  CHECK_THAT(outcome.err, ContainsSubstring("branch 0: max_points"));
  CHECK(read_csv(folder.path("r/branches.csv")).size() == 1 + 5 * 50);
  CHECK(nlohmann::json::parse(read(folder.path("r/summary.json")))["branches"][0]["stop"] == "max_points");
}

TEST_CASE("An interrupt ends the run cleanly, with what was traced") {
  const TemporaryFolder folder;
  Terminal terminal;
  Background run({"run", figure_8_case, "-o", folder.path("r"), "--set", "continuation.max_step=1e-6",
                  "--set", "continuation.max_points=1000000000"},
                 [&] { terminal.take(); });
  REQUIRE(run.wait_until([&] { return terminal.drawn() > 0; }));
  run.signal(SIGINT);
  const Outcome outcome = run.wait();
  CHECK(outcome.status == 3);
  CHECK_THAT(outcome.out, ContainsSubstring("interrupted"));
  CHECK(names_in(folder.path("r")) ==
        std::set<std::string>{"branches.csv", "curves.csv", "run.checkpoint", "summary.json"});
  const auto summary = nlohmann::json::parse(read(folder.path("r/summary.json")));
  CHECK(summary["branches"][0]["stop"] == "interrupted");
  CHECK(summary["branches"][0]["points"].get<std::size_t>() + 1 ==
        read_csv(folder.path("r/branches.csv")).size());
}

TEST_CASE("check --derivatives finds those of every kind of problem exact, with status 0") {
  for (const std::string name : {"figure_8", "cubic_response", "harmonics", "nonlinear_mode", "limit_cycle",
                                 "ridge", "enz", "bratu_2d", "lorenz84_fold_curve", "bratu_boundary",
                                 "impact_oscillator", "stick_slip", "localised_ring"}) {
    const Outcome outcome = arcslip_program("check --derivatives " + case_named(name));
    INFO(outcome.out << outcome.err);
    CHECK(outcome.status == 0);
    CHECK_THAT(outcome.out, ContainsSubstring("derivatives against differences: "));
    CHECK(outcome.out.find("NOT exact") == std::string::npos);
  }
}

TEST_CASE("check --derivatives has status 3 where there is no point to compare them at") {
  // zeta_B = -0.02 lies beyond the last limit cycle.
  const Outcome outcome =
      arcslip_program("check --derivatives " + case_named("limit_cycle") + " --set branch.start=-0.02");
  CHECK(outcome.status == 3);
  CHECK_THAT(outcome.out, ContainsSubstring("derivatives NOT compared: "));
}

TEST_CASE("Where no solution is found to start from, run and check --derivatives say so with status 3") {
  const TemporaryFolder folder;
  // Bratu's problem has no solution beyond lambda = 3.51.
  const std::string beyond = case_named("bratu") +
                             " --set system.intervals=10 --set branch.to=6 --set branch.start=5"
                             " --set branch.all_solutions=true --set continuation.stop_at=[]";
  const std::string reason = "no solution was found at lambda = 5, be it by deflation";
  const Outcome run = arcslip_program("run " + beyond + " --quiet -o " + folder.path("r"));
  CHECK(run.status == 3);
  CHECK(run.err == "arcslip: branch 0: no_start: " + reason + "\n");
  CHECK(read_csv(folder.path("r/branches.csv")).size() == 1);
  CHECK(arcslip_program("plot " + folder.path("r")).status == 1);
  const Outcome check = arcslip_program("check --derivatives " + beyond);
  CHECK(check.status == 3);
  CHECK_THAT(check.out, ContainsSubstring("derivatives NOT compared: " + reason));
}

TEST_CASE("A library model's rows hold its parameters, its unknowns, and for equilibria what is unstable") {
  const TemporaryFolder folder;
  REQUIRE(arcslip_program("run " + case_named("ab") + " --quiet -o " + folder.path("r")).status == 0);
  const auto rows = read_csv(folder.path("r/branches.csv"));
  const std::vector<std::string> header = {"branch",    "point",      "type",    "regime", "p1",
                                           "p2",        "p3",         "u1",      "u2",     "unstable",
                                           "arclength", "iterations", "residual"};
  REQUIRE(rows.front() == header);
  // One passage through hopf, fold, fold, hopf: a pair of unstable eigenvalues comes, one goes and comes
  // back, the pair goes.
  std::vector<std::string> unstable;
  for (std::size_t i = 1; i < rows.size(); ++i) {
    CHECK(rows[i][3] == "smooth");
    if (rows[i][2] == "regular" && (unstable.empty() || unstable.back() != rows[i][9]))
      unstable.push_back(rows[i][9]);
  }
  CHECK(unstable == std::vector<std::string>{"0", "2", "1", "2", "0"});
}

TEST_CASE("A periodic solution's rows tell how many multipliers lie outside the unit circle") {
  const TemporaryFolder folder;
  REQUIRE(arcslip_program("run " + case_named("lure") + " --quiet -o " + folder.path("r")).status == 0);
  const auto rows = read_csv(folder.path("r/branches.csv"));
  const std::vector<std::string> header = {"branch",   "point",     "type",       "regime",
                                           "a",        "b",         "A1",         "T",
                                           "unstable", "arclength", "iterations", "residual"};
  REQUIRE(rows.front() == header);
  bool doubled = false;
  for (std::size_t i = 1; i < rows.size(); ++i) {
    if (rows[i][2] == "period_doubling") {
      CHECK_FALSE(doubled);
      doubled = true;
    } else {
      CHECK(rows[i][8] == (doubled ? "1" : "0"));
    }
  }
  CHECK(doubled);
}

TEST_CASE("A problem without stability, and a curve, have no column of unstable eigenvalues") {
  const TemporaryFolder folder;
  for (const std::string name : {"bratu", "cusp_curve"}) {
    REQUIRE(arcslip_program("run " + case_named(name) + " --quiet -o " + folder.path(name)).status == 0);
    const auto header = read_csv(folder.path(name + "/branches.csv")).front();
    CHECK(std::find(header.begin(), header.end(), "unstable") == header.end());
  }
}

TEST_CASE("A curve's rows have the columns of a branch, with both parameters among them") {
  const TemporaryFolder folder;
  const Outcome outcome = arcslip_program("run " + case_named("ridge") + " -o " + folder.path("r"));
  CHECK(outcome.status == 0);
  const auto rows = read_csv(folder.path("r/branches.csv"));
  const std::vector<std::string> header = {"branch", "point", "type",      "regime",     "eta",
                                           "P",      "R",     "S",         "R_over_S",   "Y",
                                           "U",      "beta",  "alpha",     "psi",        "dissipated",
                                           "T_max",  "slip",  "arclength", "iterations", "residual"};
  REQUIRE(rows.front() == header);
  // At P = 1 the ridges start on the peaks of the response.
  std::vector<std::string> starts;
  for (const auto& row : rows) {
    if (row[2] == "start") starts.push_back(row[4].substr(0, 8));
  }
  CHECK(starts == std::vector<std::string>{"3.468053", "3.841129", "98.26063"});
  const auto summary = nlohmann::json::parse(read(folder.path("r/summary.json")));
  CHECK(summary["branches"].size() == 3);
  CHECK(summary["branches"][1]["peak"].is_null());  // of a ridge it would not be one of the response
}

TEST_CASE("Branches that are switched to are written one after the other") {
  const TemporaryFolder folder;
  const Outcome outcome = arcslip_program("run " + case_named("pp2") + " -o " + folder.path("r"));
  CHECK(outcome.status == 0);
  CHECK_THAT(outcome.out, ContainsSubstring("6 branches") && ContainsSubstring("0.671593847"));
  std::set<std::string> numbers;
  for (const auto& row : read_csv(folder.path("r/branches.csv"))) numbers.insert(row[0]);
  CHECK(numbers == std::set<std::string>{"branch", "0", "1", "2", "3", "4", "5"});
}

TEST_CASE("A branch that comes back out of its range, or ends where stop_after says, has status 0") {
  const TemporaryFolder folder;
  const Outcome back = arcslip_program("run " + case_named("limit_cycle") + " -o " + folder.path("a"));
  CHECK(back.status == 0);
  CHECK(back.err.empty());
  CHECK_THAT(back.out, ContainsSubstring("left_range: the branch came back to its first value"));
  const auto cycle = nlohmann::json::parse(read(folder.path("a/summary.json")))["branches"][0];
  CHECK(cycle["stop"] == "left_range");
  CHECK(cycle["first_stop"] == "left_range");

  const Outcome stopped = arcslip_program("run " + case_named("cusp") + " -o " + folder.path("b") +
                                          " --set continuation.stop_after=fold");
  CHECK(stopped.status == 0);
  const auto cusp = nlohmann::json::parse(read(folder.path("b/summary.json")))["branches"][0];
  CHECK(cusp["stop"] == "requested");
  CHECK(cusp["special"].back()["type"] == "fold");
  CHECK_THAT(cusp["special"].back()["mu"].get<double>(), WithinRel(2 / (3 * std::sqrt(3)), 1e-9));
}

TEST_CASE("A branch traced both ways has status 0 only if both parts have an end, a border among them") {
  const TemporaryFolder folder;
  // With a damper that loses energy the cycle ends on the border of stick before zeta_B = 0.
  const std::string to_the_border = "run " + case_named("limit_cycle") + " -o " + folder.path("r") +
                                    " --set system.fixed_damper=false --set system.damping.damper=1e-2";
  const Outcome before = arcslip_program(to_the_border + " --set branch.from=-1e-9");
  CHECK(before.status == 0);
  const Outcome behind = arcslip_program(to_the_border + " --set branch.from=-0.02 --set branch.to=-1e-9");
  CHECK(behind.status == 0);
  CHECK_THAT(behind.out, ContainsSubstring("left_regime: the branch ends on the border of its regime"));
  // Five points are enough for the part behind the start, which reaches its end, but not for the other one.
  const Outcome cut =
      arcslip_program("run " + case_named("limit_cycle") + " --quiet -o " + folder.path("s") +
                      " --set branch.from=-0.02 --set branch.to=-1e-4 --set continuation.max_points=7");
  CHECK(cut.status == 3);
  CHECK(is_one_line(cut.err));
  CHECK_THAT(cut.err,
             ContainsSubstring("branch 0: max_points, before the start: max_points = 7 points were stored"));
}

TEST_CASE("A curve that is nowhere found has status 3 and says where it was looked for") {
  const TemporaryFolder folder;
  const Outcome outcome = arcslip_program("run " + case_named("cubic_fold_curve") + " --quiet -o " +
                                          folder.path("r") + " --set system.preload=3");
  CHECK(outcome.status == 3);
  CHECK(is_one_line(outcome.err));
  CHECK_THAT(outcome.err, ContainsSubstring("no fold was found for eta = 0.5 to 12 at P = 3"));
}
