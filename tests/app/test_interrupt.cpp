// What is left, and said, where the program is ended before its work is done.

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "background.hpp"
#include "catch.hpp"
#include "draws.hpp"
#include "plotting.hpp"
#include "study_text.hpp"

using namespace arcslip::testing;

namespace {

std::vector<std::string> endless_run(const std::string& folder) {
  return {"run",   figure_8_case,
          "-o",    folder,
          "--set", "system.harmonics=31",
          "--set", "continuation.max_step=1e-6",
          "--set", "continuation.max_points=1000000000"};
}

/// Whether the process is there, not only for somebody to take note of its end.
bool lives(const std::string& id) {
  const std::string status = read("/proc/" + id + "/status");
  return !status.empty() && status.find("State:\tZ") == std::string::npos;
}

}  // namespace

TEST_CASE("A verification that is interrupted has status 3, and what is there of it is marked",
          "[interrupt]") {
  const TemporaryFolder folder;
  for (const int signal : {SIGINT, SIGTERM}) {
    const std::string r = folder.path(std::to_string(signal));
    Background run({"run", figure_8_case, "--verify", "-o", r, "--set", "branch.for_each.preload=[1.0]",
                    "--set", "system.elements=500"});
    // The table of a branch comes before its points are verified.
    REQUIRE(run.wait_until([&] { return !run.printed().empty(); }));
    run.signal(signal);
    const Outcome outcome = run.wait();
    CHECK(outcome.status == 3);
    CHECK_THAT(outcome.err, ContainsSubstring("interrupted"));
    CHECK(names_in(r) == std::set<std::string>{"branches.csv", "curves.csv", "offsets.csv", "run.checkpoint",
                                               "summary.json", "verify.csv"});
    const auto rows = read_csv(r + "/verify.csv");
    CHECK(rows.back().at(2) == "interrupted");
    CHECK(rows.back().size() == rows.front().size());
    const auto summary = nlohmann::json::parse(read(r + "/summary.json"));
    CHECK(summary["interrupted"] == true);
    CHECK(summary["branches"][0]["stop"] == "reached_end");
  }
}

TEST_CASE("A run without an interrupt says so", "[interrupt]") {
  const TemporaryFolder folder;
  REQUIRE(arcslip_program("run " + figure_8_case + " --quiet -o " + folder.path("r")).status == 0);
  CHECK(nlohmann::json::parse(read(folder.path("r/summary.json")))["interrupted"] == false);
}

TEST_CASE("A terminal that is closed leaves what was traced, and no temporary file", "[interrupt]") {
  const TemporaryFolder folder;
  Terminal terminal;
  Background run(endless_run(folder.path("r")), [&] { terminal.take(); });
  REQUIRE(run.wait_until([&] { return terminal.drawn() > 0; }));
  run.signal(SIGHUP);
  CHECK(run.wait().status == 3);
  CHECK(names_in(folder.path("r")) ==
        std::set<std::string>{"branches.csv", "curves.csv", "run.checkpoint", "summary.json"});
  const auto summary = nlohmann::json::parse(read(folder.path("r/summary.json")));
  CHECK(summary["interrupted"] == true);
  CHECK(summary["branches"].size() == 1);
  CHECK(read_csv(folder.path("r/branches.csv")).size() ==
        summary["branches"][0]["points"].get<std::size_t>() + 1);
}

TEST_CASE("A program that is to outlive its terminal does", "[interrupt]") {
  const TemporaryFolder folder;
  Terminal terminal;
  Background run(endless_run(folder.path("r")), [&] {
    std::signal(SIGHUP, SIG_IGN);
    terminal.take();
  });
  REQUIRE(run.wait_until([&] { return terminal.drawn() > 0; }));
  run.signal(SIGHUP);
  const int before = terminal.drawn();
  CHECK(run.wait_until([&] { return terminal.drawn() > before + 3; }));
}

TEST_CASE("A program that is killed leaves nothing, or what the next one removes", "[interrupt]") {
  const TemporaryFolder folder;
  {
    Terminal terminal;
    Background run(endless_run(folder.path("r")), [&] { terminal.take(); });
    REQUIRE(run.wait_until([&] { return terminal.drawn() > 0; }));
    run.signal(SIGKILL);
  }
  folder.write("r/branches.csv.999999999.tmp", "half of it");
  folder.write("r/study.sqlite.999999999.tmp-journal", "");
  folder.write("r/notes.999999999.tmp", "not ours");
  REQUIRE(arcslip_program("run " + figure_8_case + " --quiet -o " + folder.path("r")).status == 0);
  CHECK(names_in(folder.path("r")) ==
        std::set<std::string>{"branches.csv", "curves.csv", "notes.999999999.tmp", "summary.json"});
}

TEST_CASE("Work that does not ask ends within a second as well", "[interrupt]") {
  const TemporaryFolder folder;
  const std::string pipe = folder.path("pipe");
  REQUIRE(shell("mkfifo " + pipe).status == 0);
  for (const std::string command : {"run", "study", "check"}) {
    Background reader({command, pipe});
    REQUIRE(reader.wait_until([&] { return handles(reader.id(), SIGINT); }));
    reader.signal(SIGINT);
    const Outcome outcome = reader.wait();
    CHECK(outcome.status == 3);
    CHECK(outcome.err == "arcslip: interrupted\n");
  }
}

TEST_CASE("A study is not held up by a design that takes long, and goes on later", "[interrupt]") {
  const TemporaryFolder folder;
  const std::string path =
      folder.write("case.toml", study_text + "[continuation]\nmax_step = 1e-6\nmax_points = 1000000000\n");
  Background study({"study", path, "--quiet", "-o", folder.path("r")});
  REQUIRE(study.wait_until([&] { return std::filesystem::exists(folder.path("r/study.sqlite-wal")); }));
  study.signal(SIGTERM);
  const Outcome outcome = study.wait();
  CHECK(outcome.status == 3);
  CHECK(is_one_line(outcome.err));
  CHECK_THAT(outcome.err, ContainsSubstring("interrupted: 0 of 1 designs are done; go on with --resume"));
  CHECK(names_in(folder.path("r")) == std::set<std::string>{"study.sqlite"});
}

TEST_CASE("Python ends with the program that wants its pictures, whatever ends that one", "[interrupt]") {
  const TemporaryFolder folder;
  REQUIRE(arcslip_program("run " + figure_8_case + " --quiet -o " + folder.path("r") + " --set branch.to=1.5")
              .status == 0);
  for (const int signal : {SIGINT, SIGHUP, SIGKILL}) {
    CAPTURE(signal);
    const std::string ids = folder.path(std::to_string(signal));
    const std::string python = false_python(folder, "echo $$ >>'" + ids + "'; exec /bin/sleep 10000");
    Background plot({"plot", folder.path("r")}, [&] { setenv("ARCSLIP_PYTHON", python.c_str(), 1); });
    REQUIRE(plot.wait_until([&] { return !read(ids).empty(); }));
    plot.signal(signal);
    const Outcome outcome = plot.wait();
    CHECK(outcome.status == (signal == SIGKILL ? -1 : 3));
    CHECK(outcome.err == (signal == SIGKILL ? "" : "arcslip: interrupted\n"));
    std::istringstream all(read(ids));
    for (std::string id; all >> id;) {
      while (lives(id)) std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    CHECK(names_in(folder.path("r")) == run_results);
  }
}

namespace {

/// The run of a case, interrupted as soon as it draws its line, once more when it is gone on with (behind its
/// first branch, if it has more), and then brought to its end: against the same run done at once.
void check_resumed(const std::string& path, const std::vector<std::string>& settings, bool has_more = false) {
  const TemporaryFolder folder;
  std::string words;
  std::vector<std::string> run = {"run", path};
  for (const std::string& setting : settings) {
    run.insert(run.end(), {"--set", setting});
    words += " --set " + setting;
  }
  const Outcome whole = arcslip_program("run " + path + words + " --quiet -o " + folder.path("whole"));
  CAPTURE(path, whole.err);
  const auto interrupted = [&](const char* into, const auto& is_time) {
    std::vector<std::string> words_of_run = run;
    words_of_run.insert(words_of_run.end(), {into, folder.path("r")});
    Terminal terminal;
    Background work(words_of_run, [&] { terminal.take(); });
    const bool in_time = work.wait_until([&] { return is_time(work, terminal); });
    work.signal(SIGINT);
    work.wait();
    return in_time && names_in(folder.path("r")).contains("run.checkpoint");
  };
  const auto draws = [](const Background&, Terminal& terminal) { return terminal.drawn() > 0; };
  const auto prints = [](const Background& work, Terminal&) { return !work.printed().empty(); };
  bool is_begun = false;  // a quick run may end before the signal comes: it is begun anew
  for (int i = 0; i < 50 && !is_begun; ++i) is_begun = interrupted("-o", draws);
  REQUIRE(is_begun);
  // What is left may be done before it is interrupted again.
  const bool once_more = has_more ? interrupted("--resume", prints) : interrupted("--resume", draws);
  if (once_more || names_in(folder.path("r")).contains("run.checkpoint")) {
    const Outcome rest = arcslip_program("run " + path + words + " --quiet --resume " + folder.path("r"));
    INFO(rest.err);
    CHECK(rest.status == whole.status);
  }
  CHECK(names_in(folder.path("r")) == run_results);
  for (const char* name : {"/branches.csv", "/curves.csv"})
    CHECK(read(folder.path("r") + name) == read(folder.path("whole") + name));
}

}  // namespace

TEST_CASE("An interrupted run goes on to the tables of one that was not", "[interrupt]") {
  // Steps so short that there is time to interrupt: under the sanitizers each takes several times as long.
  const auto step = [](double longest) {
    return fmt::format("continuation.max_step={:g}", sanitized ? 3 * longest : longest);
  };
  SECTION("several branches") {
    check_resumed(figure_8_case, {"branch.for_each.preload=[0.5,5.0]", "system.harmonics=9", step(0.001)},
                  true);
  }
  SECTION("branches that are switched to") {
    check_resumed(figure_8_case, {"branch.for_each.preload=[5.0]", "branch.switching=true",
                                  "system.harmonics=15", step(0.001)});
  }
  SECTION("a curve in two parameters") { check_resumed(case_named("lorenz84_hopf_curve"), {step(1e-4)}); }
}

TEST_CASE("A run whose branches had no time to be whole goes on to the tables of one that had",
          "[interrupt]") {
  const auto check = [](const std::string& command, const char* first) {
    const TemporaryFolder folder;
    const std::string run = "run " + command + " --quiet ";
    const Outcome whole = arcslip_program(run + "-o " + folder.path("whole"));
    CHECK(whole.status == 0);
    Outcome part =
        arcslip_program(run + "-o " + folder.path("r") + " --set continuation.max_seconds=" + first);
    CHECK(part.status == 3);
    CHECK_THAT(part.err, ContainsSubstring("time_limit"));
    CHECK(names_in(folder.path("r")).contains("run.checkpoint"));
    double seconds = 0.01;
    for (; part.status == 3 && seconds < 1000; seconds *= 3)
      part = arcslip_program(run + "--resume " + folder.path("r") +
                             fmt::format(" --set continuation.max_seconds={}", seconds));
    INFO(part.err);
    CHECK(part.status == 0);
    CHECK(names_in(folder.path("r")) == names_in(folder.path("whole")));
    for (const std::string& name : names_in(folder.path("whole"))) {
      if (name.ends_with(".csv"))
        CHECK(read(folder.path("r") + "/" + name) == read(folder.path("whole") + "/" + name));
    }
  };
  SECTION("several branches, of which some are whole") {
    check(figure_8_case + " --set branch.for_each.preload=[0.5,50.0,5.0] --set continuation.max_step=0.01",
          "1e-3");
  }
  SECTION("several curves in two parameters") { check(case_named("border"), "5e-4"); }
  SECTION("a curve of peaks") { check(case_named("ridge"), "0.01"); }
  SECTION("branches of a boundary value problem, on meshes of their own") {
    check(case_named("buckling_boundary") + " --set cycles.tolerance=1e-8", "0.05");
  }
  SECTION("cycles under a load") {
    check(case_named("forced_duffing") + " --set continuation.max_step=0.005", "0.05");
  }
}

TEST_CASE("Only an interrupted run of the same case is gone on with", "[interrupt]") {
  const TemporaryFolder folder;
  const std::string r = folder.path("r");
  const auto resumed = [&](const std::string& more) {
    const Outcome outcome = arcslip_program("run " + figure_8_case + " --resume " + r + more);
    CHECK(outcome.status == 1);
    CHECK(std::count(outcome.err.begin(), outcome.err.end(), '\n') == 1);
    return outcome.err;
  };
  CHECK_THAT(resumed(""), ContainsSubstring("there is no interrupted run"));
  Terminal terminal;
  Background run(endless_run(r), [&] { terminal.take(); });
  REQUIRE(run.wait_until([&] { return terminal.drawn() > 0; }));
  run.signal(SIGINT);
  CHECK(run.wait().status == 3);
  const auto tables = read(r + "/branches.csv");
  CHECK_THAT(resumed(""), ContainsSubstring("a run of another case, which differs in"));
  CHECK(read(r + "/branches.csv") == tables);
  folder.write("r/run.checkpoint", "arcslip-run-checkpoint-1\n{}\n");
  CHECK_THAT(resumed(""), ContainsSubstring("it is damaged"));
  CHECK(arcslip_program("run " + figure_8_case + " --resume " + r + " -o " + r).status == 2);
}
