// arcslip study as a user meets it: files, threads, kills, interrupts.

#include <sys/resource.h>
#include <sys/time.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <random>

#include "background.hpp"
#include "catch.hpp"
#include "program.hpp"
#include "results/database.hpp"
#include "study_text.hpp"

using namespace arcslip::testing;

namespace {

/// Seconds of computing that the processes took that are waited for.
double seconds_of_children() {
  rusage usage;
  getrusage(RUSAGE_CHILDREN, &usage);
  return static_cast<double>(usage.ru_utime.tv_sec + usage.ru_stime.tv_sec) +
         1e-6 * static_cast<double>(usage.ru_utime.tv_usec + usage.ru_stime.tv_usec);
}

/// Kills this process when it has computed for so many seconds.
void kill_after(double seconds) {
  const auto whole = static_cast<time_t>(seconds);
  const itimerval timer = {
      {}, {whole, std::max<suseconds_t>(1, std::lround(1e6 * (seconds - static_cast<double>(whole))))}};
  setitimer(ITIMER_PROF, &timer, nullptr);
}

std::map<std::string, std::string> tables_in(const std::string& folder) {
  return {{"optimum", read(folder + "/optimum.csv")}, {"sweep", read(folder + "/sweep.csv")}};
}

/// The designs stored, each with the run of the program that stored it.
std::map<std::int64_t, std::int64_t> stored(const std::string& folder) {
  std::map<std::int64_t, std::int64_t> runs;
  const std::string path = folder + "/study.sqlite";
  if (!std::filesystem::exists(path)) return runs;
  arcslip::Database database(path);
  database.execute("PRAGMA busy_timeout = 60000");
  for (auto row = database.prepare("SELECT curve, run FROM designs"); row.step();)
    runs[row.integer(0)] = row.integer(1);
  return runs;
}

const std::set<std::string> all_files = {"optimum.csv", "study.sqlite", "summary.json", "sweep.csv"};

}  // namespace

TEST_CASE("study writes its tables whole, prints the optima and nothing on stderr", "[study]") {
  const TemporaryFolder folder;
  const std::string path = folder.write("case.toml", "title = \"Two designs\"\n" + study_text +
                                                         "for_each = { mass_ratio = [5.0, 10.0] }\n"
                                                         "[continuation]\nstop_at = [1.0]\n");
  const Outcome outcome = arcslip_program("study " + path + " -o " + folder.path("r"));
  CHECK(outcome.status == 0);
  CHECK(outcome.err.empty());
  CHECK_THAT(outcome.out, ContainsSubstring("Two designs") && ContainsSubstring("mass_ratio") &&
                              ContainsSubstring("2 designs"));
  CHECK(names_in(folder.path("r")) == all_files);

  const auto optimum = read_csv(folder.path("r/optimum.csv"));
  REQUIRE(optimum.size() == 3);
  const std::vector<std::string> columns = {"curve",
                                            "mass_ratio",
                                            "P_opt",
                                            "eta_opt",
                                            "Y_opt",
                                            "ratio_opt",
                                            "kind",
                                            "P_low",
                                            "P_high",
                                            "Y_nd_max",
                                            "R_over_S",
                                            "dissipated",
                                            "energy",
                                            "zeta_eq",
                                            "site",
                                            "by_P",
                                            "by_mu",
                                            "by_F",
                                            "by_mass_ratio",
                                            "by_frequency_ratio",
                                            "eta_other",
                                            "by_P_other",
                                            "by_mu_other",
                                            "by_F_other",
                                            "by_mass_ratio_other",
                                            "by_frequency_ratio_other"};
  CHECK(optimum[0] == columns);
  CHECK(optimum[2][1] == "10");
  // The best preload of figure 8 lies near P = 1, where its highest peak is at eta = 3.84 [paper].
  CHECK_THAT(std::stod(optimum[1][2]), WithinRel(1, 0.05));
  CHECK_THAT(std::stod(optimum[1][3]), WithinRel(3.84, 0.02));

  const auto sweep = read_csv(folder.path("r/sweep.csv"));
  const std::vector<std::string> header = {"curve",
                                           "peak_branch",
                                           "P",
                                           "eta_peak",
                                           "Y_max",
                                           "Y_nd_max",
                                           "ratio",
                                           "R_over_S",
                                           "dissipated",
                                           "is_global",
                                           "type",
                                           "site",
                                           "by_P",
                                           "by_mu",
                                           "by_F",
                                           "by_mass_ratio",
                                           "by_frequency_ratio"};
  REQUIRE(sweep[0] == header);
  std::set<std::string> curves, types;
  for (std::size_t i = 1; i < sweep.size(); ++i) {
    curves.insert(sweep[i][0]);
    types.insert(sweep[i][10]);
    CHECK(std::stod(sweep[i][6]) == std::stod(sweep[i][4]) / std::stod(sweep[i][5]));
    if (sweep[i][10] == "user") CHECK(sweep[i][2] == "1");
  }
  CHECK(curves == std::set<std::string>{"0", "1"});
  for (const std::string type : {"start", "end", "optimum", "user"}) CHECK(types.contains(type));

  const auto summary = nlohmann::json::parse(read(folder.path("r/summary.json")));
  CHECK(summary["title"] == "Two designs");
  CHECK(summary["designs"] == 2);
  CHECK(summary["failed"].empty());
  CHECK(summary["case"]["study"]["for_each"]["mass_ratio"][1] == 10.0);
}

TEST_CASE("Designs of the case files have the optima that closed forms and curves of peaks give", "[study]") {
  const TemporaryFolder folder;
  REQUIRE(arcslip_program("study " + case_named("chart") + " --quiet -o " + folder.path("r") +
                          " --set study.for_each.mass_ratio=[1.0,5.0] --set "
                          "study.for_each.frequency_ratio=[1.0,4.0]")
              .status == 0);
  const auto rows = read_csv(folder.path("r/optimum.csv"));
  REQUIRE(rows.size() == 5);
  CHECK(names_in(folder.path("r")) == std::set<std::string>{"optimum.csv", "study.sqlite", "summary.json"});
  // gamma = 1: stuck together, base and damper have the same frequency and damping as each alone, and the
  // mass 1 + 1/M*. What is left is the coupling of the parts' damping, of the order of zeta = 1e-4.
  for (const int row : {1, 3}) {
    const double mass_ratio = std::stod(rows[static_cast<std::size_t>(row)][1]);
    CHECK_THAT(std::stod(rows[static_cast<std::size_t>(row)][6]),
               WithinRel(mass_ratio / (1 + mass_ratio), 1e-4));
    CHECK(rows[static_cast<std::size_t>(row)][7] == "flat");
  }
  // M* = 5, gamma = 4: the trough of problems/ridge.toml, to the digits given there.
  CHECK_THAT(std::stod(rows[4][3]), WithinRel(1.04129171, 1e-8));
  CHECK_THAT(std::stod(rows[4][4]), WithinRel(3.82092304, 1e-8));
  CHECK_THAT(std::stod(rows[4][5]), WithinRel(0.00715396993, 1e-8));

  REQUIRE(arcslip_program("study " + case_named("wave_numbers") + " --quiet -o " + folder.path("s") +
                          " --set study.for_each.wave_number=[1,2,4,8] --set study.sweep=false")
              .status == 0);
  const auto waves = read_csv(folder.path("s/optimum.csv"));
  REQUIRE(waves.size() == 5);
  // As the case file says.
  const double factors[] = {448, 131, 61, 1 / 0.62};
  for (std::size_t i = 0; i < 4; ++i) CHECK_THAT(1 / std::stod(waves[i + 1][5]), WithinRel(factors[i], 0.01));
  CHECK(waves[3][6] == "exchange");
}

TEST_CASE("study says in a sentence that a window has no resonance or an optimum lies on the range's end",
          "[study]") {
  const TemporaryFolder folder;
  const std::string path =
      folder.write("case.toml", study_text + "for_each = { frequency_ratio = [3.5, 4.0] }\n");
  const auto remarks = [&](const std::string& settings) {
    const Outcome outcome =
        arcslip_program("study " + path + " -o " + folder.path("r") + " --set study.sweep=false" + settings);
    CHECK(outcome.status == 0);
    std::string all;
    const auto summary = nlohmann::json::parse(read(folder.path("r/summary.json")));
    for (const auto& sentence : summary.at("remarks")) all += "\n" + sentence.get<std::string>() + "\n";
    CHECK_THAT(outcome.out, ContainsSubstring(all));
    const std::size_t of_harmonics = all.find("\nMore harmonics were tried at the best preloads of 2 of 2 ");
    REQUIRE(of_harmonics != std::string::npos);
    return all.substr(0, of_harmonics);
  };
  CHECK(remarks("").empty());
  CHECK(remarks(" --set study.eta=[3.6,6]") ==
        "\nWithout damper Y is highest on an end of the window eta = 3.6 to 6, not at a resonance in it in 1 "
        "of "
        "2 designs (curve 0): the ratio compares with that.\n");
  CHECK(
      remarks(" --set study.to=1.0") ==
      "\nY_max is lowest on an end of the range P = 0.9 to 1 in 2 of 2 designs (curves 0, 1): beyond it may "
      "lie a better preload.\n");
}

TEST_CASE("The tables do not depend on the number of threads", "[study]") {
  const TemporaryFolder folder;
  const std::string path = folder.write("case.toml", chart_text);
  for (const std::string jobs : {"1", "5"})
    REQUIRE(
        arcslip_program("study " + path + " --quiet --jobs " + jobs + " -o " + folder.path(jobs)).status ==
        0);
  CHECK(tables_in(folder.path("1")) == tables_in(folder.path("5")));
}

TEST_CASE("A study killed ten times ends as if it had not been, and computes no stored design again",
          "[study]") {
  const TemporaryFolder folder;
  const std::string path = folder.write("case.toml", chart_text);
  const auto words = [&](const std::string& name) -> std::vector<std::string> {
    return {"study",    path, "--quiet",         "--jobs", "1",
            "--resume", "-o", folder.path(name), "--set",  "study.for_each.frequency_ratio.count=48"};
  };
  // Of computing, not of the clock.
  const auto seconds_of = [](const std::vector<std::string>& command) {
    const double start = seconds_of_children();
    REQUIRE(Background(command).wait().status == 0);
    return seconds_of_children() - start;
  };
  const double beginning = seconds_of({"check", path});
  const double designs = seconds_of(words("whole")) - beginning;

  std::mt19937 random(1);
  // All ten together are about a third of the study.
  std::uniform_real_distribution<double> moment(beginning, beginning + designs / 15);
  std::map<std::int64_t, std::int64_t> before;
  for (int i = 0; i < 10; ++i) {
    Background process(words("killed"), [seconds = moment(random)] { kill_after(seconds); });
    CHECK(process.wait().status == -1);
    if (i % 3 != 0) continue;  // a look tidies the database, which the next run is to do itself
    const auto now = stored(folder.path("killed"));
    // A design that was computed again would bear the number of a later run.
    for (const auto& [curve, run] : before) CHECK(now.at(curve) == run);
    before = now;
  }
  CHECK_FALSE(before.empty());
  CHECK(Background(words("killed")).wait().status == 0);
  const auto now = stored(folder.path("killed"));
  CHECK(now.size() == 192);
  for (const auto& [curve, run] : before) CHECK(now.at(curve) == run);
  CHECK(tables_in(folder.path("killed")) == tables_in(folder.path("whole")));
  CHECK(names_in(folder.path("killed")) == all_files);
}

TEST_CASE("An interrupt ends a study cleanly, and it goes on with --resume", "[study]") {
  const TemporaryFolder folder;
  const std::string path = folder.write("case.toml", chart_text);
  Outcome outcome{};
  std::string designs, r;
  // One that ends before the interrupt comes to it is made longer.
  for (int count = 6; outcome.status == 0 && count < 1000; count *= 2) {
    designs = "study.for_each.frequency_ratio.count=" + std::to_string(count);
    r = folder.path(std::to_string(4 * count));
    Background study({"study", path, "--quiet", "--jobs", "1", "-o", r, "--set", designs});
    // While it runs, what it stores stands beside its database.
    study.wait_until([&] { return std::filesystem::exists(r + "/study.sqlite-wal") && !stored(r).empty(); });
    study.signal(SIGINT);
    outcome = study.wait();
  }
  CHECK(outcome.status == 3);
  CHECK(is_one_line(outcome.err));
  CHECK_THAT(outcome.err,
             ContainsSubstring("interrupted: ") &&
                 ContainsSubstring("of " + r.substr(folder.path("").size()) + " designs are done") &&
                 ContainsSubstring("go on with --resume"));
  CHECK(names_in(r) == std::set<std::string>{"study.sqlite"});
  const std::string command = "study " + path + " --quiet --set " + designs + " -o ";
  CHECK(arcslip_program(command + r + " --resume").status == 0);
  REQUIRE(arcslip_program(command + folder.path("s")).status == 0);
  CHECK(tables_in(r) == tables_in(folder.path("s")));
}

TEST_CASE("Without --resume a study is begun anew, with --resume only the same one goes on", "[study]") {
  const TemporaryFolder folder;
  const std::string path = folder.write("case.toml", study_text + "for_each = { mass_ratio = [5, 10] }\n");
  const std::string command = "study " + path + " -o " + folder.path("r");
  REQUIRE(arcslip_program(command).status == 0);
  const auto before = tables_in(folder.path("r"));
  const Outcome other = arcslip_program(command + " --resume --set study.to=1.3");
  CHECK(other.status == 1);
  CHECK(is_one_line(other.err));
  CHECK_THAT(other.err, ContainsSubstring("study.sqlite: --resume: it was begun with another study.to"));
  CHECK(tables_in(folder.path("r")) == before);
  const Outcome same = arcslip_program(command + " --resume");
  CHECK(same.status == 0);
  CHECK_THAT(same.out, ContainsSubstring("2 were done before"));
  CHECK(tables_in(folder.path("r")) == before);
  CHECK(arcslip_program(command + " --quiet --set study.sweep=false --set study.to=1.3").status == 0);
  CHECK(names_in(folder.path("r")) == std::set<std::string>{"optimum.csv", "study.sqlite", "summary.json"});
}

TEST_CASE("A design that fails is named with its reason, and has status 3", "[study]") {
  const TemporaryFolder folder;
  const std::string path = folder.write("case.toml", study_text + "for_each = { mass_ratio = [5, 10] }\n");
  const Outcome outcome = arcslip_program("study " + path + " --quiet -o " + folder.path("r") +
                                          " --set continuation.max_points=5");
  CHECK(outcome.status == 3);
  CHECK_THAT(outcome.err, ContainsSubstring("arcslip: design 0 (mass_ratio = 5): ") &&
                              ContainsSubstring("arcslip: design 1 (mass_ratio = 10): "));
  CHECK(read_csv(folder.path("r/optimum.csv"))[1][6] == "failed");
}

TEST_CASE("A study that cannot be written has status 4 and one line", "[study]") {
  const TemporaryFolder folder;
  const std::string path = folder.write("case.toml", chart_text);
  folder.write("file", "");
  const Outcome blocked = arcslip_program("study " + path + " -o " + folder.path("file/below"));
  CHECK(blocked.status == 4);
  CHECK(is_one_line(blocked.err));

  // A limit on the size of files stands for the full disk.
  const std::string command = "'" + program + "' study " + path + " --quiet -o " + folder.path("r");
  const Outcome full = shell("ulimit -f 150; " + command);
  CHECK(full.status == 4);
  CHECK(is_one_line(full.err));
  CHECK_THAT(full.err, ContainsSubstring("cannot be written"));
  CHECK_FALSE(std::filesystem::exists(folder.path("r/optimum.csv")));
  CHECK(shell(command + " --resume").status == 0);
  CHECK(names_in(folder.path("r")) == all_files);

  // As a study that is running holds it.
  arcslip::Database other(folder.path("r/study.sqlite"));
  other.execute("PRAGMA journal_mode = WAL; DELETE FROM runs");
  const Outcome used = shell(command);
  CHECK(used.status == 4);
  CHECK(is_one_line(used.err));
  CHECK_THAT(used.err, ContainsSubstring("another program uses it"));
}

TEST_CASE("check says what a study would do, and refuses what study would refuse", "[study]") {
  const TemporaryFolder folder;
  const std::string path = folder.write("case.toml", chart_text);
  const Outcome outcome = arcslip_program("check " + path);
  CHECK(outcome.status == 0);
  CHECK_THAT(outcome.out,
             ContainsSubstring("study of 24 designs: P from 0.9 to 1.2, peaks between eta = 3 and 5") &&
                 ContainsSubstring("mass_ratio: 4 values, 5 to 50") &&
                 ContainsSubstring("frequency_ratio: 6 values, 3.5 to 4.5, linear") &&
                 ContainsSubstring("design 23: mass_ratio = 50, frequency_ratio = 4.5"));
  const Outcome bad = arcslip_program("check " + path + " --set study.from=-1");
  CHECK(bad.status == 1);
  CHECK(is_one_line(bad.err));
  CHECK(arcslip_program("check --derivatives " + path).status == 1);
  const Outcome both =
      arcslip_program("check " + path +
                      " --set system.preload=1.0 --set branch.parameter=eta --set branch.from=1.0 "
                      "--set branch.to=2.0");
  CHECK_THAT(both.out, ContainsSubstring("study of 24 designs") && ContainsSubstring("branch 0"));
}

TEST_CASE("A study's command line is checked and explained", "[study]") {
  for (const std::string arguments : {"study", "study a.toml --jobs 0", "study a.toml --jobs many"}) {
    const Outcome outcome = arcslip_program(arguments);
    CHECK(outcome.status == 2);
    CHECK(is_one_line(outcome.err));
  }
  CHECK_THAT(arcslip_program("study --help").out, ContainsSubstring("--resume") &&
                                                      ContainsSubstring("for_each") &&
                                                      ContainsSubstring("optimum.csv"));
  CHECK_THAT(arcslip_program("--help").out, ContainsSubstring("study"));
}
