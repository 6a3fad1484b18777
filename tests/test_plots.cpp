// The pictures of `arcslip plot`: that they are drawn whole, and what is said where they cannot be.

#include <sys/wait.h>

#include <algorithm>
#include <cstdlib>
#include <set>
#include <string>
#include <vector>

#include "catch.hpp"
#include "temporary_folder.hpp"

using arcslip::testing::read;
using arcslip::testing::TemporaryFolder;

namespace {

namespace fs = std::filesystem;

const std::set<std::string> results = {"branches.csv", "summary.json"};
const std::vector<std::string> pictures = {"amplitude", "relative", "phases", "dissipated"};

struct Outcome {
  int status;
  std::string out;
  std::string err;
};

/// What the program does in a shell; `before` are the variables set for it.
Outcome arcslip_program(const std::string& arguments, const std::string& before = "") {
  const TemporaryFolder folder;
  const std::string command = before + " '" ARCSLIP_PROGRAM "' " + arguments + " >'" + folder.path("out") +
                              "' 2>'" + folder.path("err") + "'";
  const int code = std::system(command.c_str());
  return {WIFEXITED(code) ? WEXITSTATUS(code) : -1, read(folder.path("out")), read(folder.path("err"))};
}

void run(const std::string& problem, const std::string& folder, const std::string& options = "") {
  const Outcome outcome = arcslip_program("run '" ARCSLIP_SOURCE_DIR "/problems/" + problem +
                                          ".toml' --quiet -o \"" + folder + "\" " + options);
  REQUIRE(outcome.err.empty());
  REQUIRE(outcome.status == 0);
}

/// Whether pictures can be drawn here; a warning if not.
bool has_gnuplot() {
  if (std::system("command -v gnuplot >/dev/null 2>&1") == 0) return true;
  WARN("gnuplot is not installed: nothing is drawn");
  return false;
}

std::set<std::string> names_in(const std::string& folder) {
  std::set<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder)) names.insert(entry.path().filename().string());
  return names;
}

bool is_one_line(const std::string& text) { return !text.empty() && text.find('\n') == text.size() - 1; }

/// Requires all pictures in the folder, from their first bytes to their last, and nothing besides.
void require_pictures(const std::string& folder, std::size_t least_size) {
  std::set<std::string> expected = results;
  for (const std::string& picture : pictures) {
    CAPTURE(picture);
    const fs::path path = fs::path(folder) / picture;
    const std::string png = read(path.string() + ".png");
    const std::string svg = read(path.string() + ".svg");
    CHECK(png.size() > least_size);
    CHECK(svg.size() > least_size);
    CHECK(png.substr(0, 8) == "\x89PNG\r\n\x1a\n");
    CHECK(png.substr(png.size() - std::min<std::size_t>(png.size(), 8), 4) == "IEND");
    CHECK_THAT(svg.substr(0, 200), ContainsSubstring("<?xml") && ContainsSubstring("<svg"));
    CHECK(svg.find("</svg>") != std::string::npos);
    expected.insert({picture + ".png", picture + ".svg"});
  }
  CHECK(names_in(folder) == expected);
}

/// A folder with a stand-in for gnuplot: a shell script of this text.
std::string path_with_gnuplot(const TemporaryFolder& folder, const std::string& script) {
  fs::create_directories(folder.path("bin"));
  const std::string file = folder.write("bin/gnuplot", "#!/bin/sh\n" + script);
  fs::permissions(file, fs::perms::owner_all);
  return "PATH='" + folder.path("bin") + "'";
}

}  // namespace

TEST_CASE("plot draws every picture whole, as PNG and SVG, and names them", "[plots]") {
  if (!has_gnuplot()) return;
  const TemporaryFolder folder;
  const std::string results_folder = folder.path(R"(figure 8's "own")");
  const std::string quoted = folder.path(R"(figure 8's \"own\")");  // for the shell, between double quotes
  run("figure_8", quoted);
  const Outcome outcome = arcslip_program("plot \"" + quoted + "\"");
  CHECK(outcome.err.empty());
  CHECK(outcome.status == 0);
  require_pictures(results_folder, 40'000);
  std::string listed;
  for (const std::string& picture : pictures) {
    for (const char* ending : {".png", ".svg"}) {
      listed.append(results_folder).append("/").append(picture).append(ending).append("\n");
    }
  }
  CHECK(outcome.out == listed);
}

TEST_CASE("plot names axis and branches by the symbols of the paper", "[plots]") {
  if (!has_gnuplot()) return;
  const TemporaryFolder folder;
  run("preload_response", folder.path("r"));
  REQUIRE(arcslip_program("plot " + folder.path("r")).status == 0);
  require_pictures(folder.path("r"), 20'000);
  const std::string svg = read(folder.path("r/amplitude.svg"));
  CHECK_THAT(svg, ContainsSubstring(">P<") && ContainsSubstring(">η<") && ContainsSubstring("3.68"));
}

TEST_CASE("plot names all of a few branches and some of many", "[plots]") {
  if (!has_gnuplot()) return;
  const TemporaryFolder folder;
  const auto drawn = [&](int branches) {
    std::string preloads = "0.5";
    for (int i = 1; i < branches; ++i) preloads.append(",").append(std::to_string(i));
    run("figure_8", folder.path("r"), "--set branch.to=6 --set 'branch.for_each.preload=[" + preloads + "]'");
    REQUIRE(arcslip_program("plot " + folder.path("r")).status == 0);
    return read(folder.path("r/amplitude.svg"));
  };
  const auto named = [](const std::string& svg) {
    int count = 0;
    for (std::size_t at = 0; (at = svg.find(">P<", at)) != std::string::npos; ++at) ++count;
    return count;
  };
  CHECK(named(drawn(12)) == 12);
  CHECK(named(drawn(30)) == 6);
}

TEST_CASE("plot draws what there is of a run that was cut short", "[plots]") {
  if (!has_gnuplot()) return;
  const std::size_t rows = GENERATE(1, 2, 3, 700);
  CAPTURE(rows);
  const TemporaryFolder folder;
  run("figure_8", folder.path("r"));
  const std::string table = read(folder.path("r/branches.csv"));
  std::size_t end = 0;
  for (std::size_t i = 0; i <= rows; ++i) end = table.find('\n', end) + 1;
  folder.write("r/branches.csv", table.substr(0, end));
  const Outcome outcome = arcslip_program("plot " + folder.path("r"));
  CHECK(outcome.err.empty());
  CHECK(outcome.status == 0);
  require_pictures(folder.path("r"), 2'000);
}

TEST_CASE("plot draws quantities that are not defined as empty panels", "[plots]") {
  if (!has_gnuplot()) return;
  const TemporaryFolder folder;
  run("figure_8", folder.path("r"), "--set branch.to=1.5");  // no slip: nothing is dissipated
  const Outcome outcome = arcslip_program("plot " + folder.path("r"));
  CHECK(outcome.err.empty());
  CHECK(outcome.status == 0);
  CHECK_THAT(read(folder.path("r/dissipated.svg")), ContainsSubstring("nothing to show"));
}

TEST_CASE("plot says in one line that gnuplot is missing, or why it failed, and leaves nothing behind",
          "[plots]") {
  const TemporaryFolder folder;
  run("figure_8", folder.path("r"), "--set branch.to=1.5");
  const auto fails = [&](const std::string& path, const std::string& message) {
    CAPTURE(message);
    const Outcome outcome = arcslip_program("plot " + folder.path("r"), path);
    CHECK(outcome.status == 4);
    CHECK(is_one_line(outcome.err));
    CHECK_THAT(outcome.err, ContainsSubstring(message));
    CHECK(outcome.out.empty());
    CHECK(names_in(folder.path("r")) == results);
  };
  fails("PATH=/nonexistent",
        "arcslip plot: gnuplot was not found; install it (Debian: apt-get install gnuplot-nox)\n");
  fails(path_with_gnuplot(folder, "echo first >&2; echo the reason >&2; exit 2"),
        "gnuplot failed: the reason");
  fails(path_with_gnuplot(folder, "echo a part >\"$6\""), "amplitude.png: cannot be drawn");
  fails(path_with_gnuplot(folder, "kill -9 $$"), "signal 9");
}

TEST_CASE("plot refuses a folder without results, in one line that names the file", "[plots]") {
  const TemporaryFolder folder;
  run("figure_8", folder.path("whole"), "--set branch.to=1.5");
  const std::string table = read(folder.path("whole/branches.csv"));
  const std::string summary = read(folder.path("whole/summary.json"));
  const std::string header = table.substr(0, table.find('\n') + 1);
  const auto refuses = [&](const std::string& name, const std::string& csv, const std::string& json,
                           const char* file, const char* reason) {
    CAPTURE(name);
    fs::create_directories(folder.path(name));
    if (!csv.empty()) folder.write(name + "/branches.csv", csv);
    if (!json.empty()) folder.write(name + "/summary.json", json);
    const Outcome outcome = arcslip_program("plot '" + folder.path(name) + "'");
    CHECK(outcome.status == 1);
    CHECK(is_one_line(outcome.err));
    CHECK_THAT(outcome.err, ContainsSubstring(folder.path(name + "/" + file)) && ContainsSubstring(reason));
  };
  refuses("empty", "", "", "branches.csv", "cannot be read");
  refuses("header only", header, summary, "branches.csv", "holds no points");
  refuses("no column", "branch,point\n0,0\n", summary, "branches.csv", "has no column type");
  refuses("no summary", table, "", "summary.json", "cannot be read");
  refuses("cut", table, summary.substr(0, summary.size() / 2), "summary.json", "is not JSON");
  refuses("another", table, "[1, 2]", "summary.json", "is not a summary");

  const Outcome outcome = arcslip_program("plot " + folder.path("none"));
  CHECK(outcome.status == 1);
  CHECK(is_one_line(outcome.err));
  CHECK_THAT(outcome.err, ContainsSubstring(folder.path("none")));
}
