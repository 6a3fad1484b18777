// `arcslip report`: what a page holds, and what is said where there can be none. How it looks in a browser is
// for report_browser.py.

#include <nlohmann/json.hpp>

#include "plotting.hpp"
#include "study_text.hpp"

using namespace arcslip::testing;
using nlohmann::json;

namespace {

/// Where the build has put the library that draws.
fs::path build_share() { return fs::path(program).parent_path().parent_path() / "share/arcslip"; }

bool has_plotly() {
  if (fs::exists(build_share() / "report/plotly-basic.min.js")) return true;
  WARN("plotly.js is not there: no report is written");
  return false;
}

/// Runs figure 8 up to eta = `to`.
void run_figure_8(const TemporaryFolder& folder, const std::string& name, const std::string& to = "1.5") {
  REQUIRE(arcslip_program("run '" + figure_8_case + "' --quiet -o '" + folder.path(name) +
                          "' --set branch.to=" + to)
              .status == 0);
}

Outcome report(const std::string& folder) { return arcslip_program("report '" + folder + "'"); }

/// The data in a page.
json data_in(const std::string& folder) {
  const std::string page = read(folder + "/report.html");
  const std::string opening = "id=\"data\">\n";
  const std::size_t at = page.find(opening) + opening.size();
  return json::parse(page.substr(at, page.find("\n</script>", at) - at));
}

/// A copy of the program with parts of what it finds beside itself.
std::string program_with(const TemporaryFolder& folder, bool plots) {
  fs::create_directories(folder.path("bin"));
  fs::create_directories(folder.path("share/arcslip"));
  fs::copy(program, folder.path("bin/arcslip"));
  if (plots) fs::create_directory_symlink(build_share() / "plots", folder.path("share/arcslip/plots"));
  return folder.path("bin/arcslip");
}

}  // namespace

TEST_CASE("report writes one page with all rows of a run, the same each time", "[report]") {
  if (!has_plotly()) return;
  const TemporaryFolder folder;
  const std::string name = R"(a "folder" of <results>)";
  REQUIRE(
      shell("'" + program + "' run '" + figure_8_case + "' --quiet -o '" + folder.path(name) + "'").status ==
      0);
  const Outcome outcome = report(folder.path(name));
  CHECK(outcome.err.empty());
  CHECK(outcome.status == 0);
  CHECK(outcome.out == folder.path(name) + "/report.html\n");
  const json data = data_in(folder.path(name));
  const auto rows = read_csv(folder.path(name + "/curves.csv"));
  CHECK(data["run"]["table"] == "curves.csv");
  const json& points = data["run"]["points"];
  CHECK(points["rows"] == rows.size() - 1);
  CHECK(points["every"] == 1);
  REQUIRE(points["columns"]["Y"].size() == rows.size() - 1);
  const std::size_t Y =
      static_cast<std::size_t>(std::find(rows[0].begin(), rows[0].end(), "Y") - rows[0].begin());
  for (std::size_t i = 1; i < rows.size(); i += 97)
    CHECK(points["columns"]["Y"][i - 1].get<double>() == std::stod(rows[i][Y]));
  const json& regime = points["columns"]["regime"];
  CHECK(regime["words"][regime["at"][0].get<std::size_t>()] == "stick");
  CHECK_FALSE(points["columns"].contains("residual"));
  const std::string page = read(folder.path(name + "/report.html"));
  REQUIRE(report(folder.path(name)).status == 0);
  CHECK(read(folder.path(name + "/report.html")) == page);
}

TEST_CASE("report shows what there is, of a run, a study or both", "[report]") {
  if (!has_plotly()) return;
  const TemporaryFolder folder;
  const std::string words =
      folder.write("case.toml", study_text +
                                    "[branch]\nparameter = \"eta\"\nfrom = 3.0\nto = 5.0\n"
                                    "for_each = { preload = [1] }\n") +
      " --quiet --set system.elements=5 -o " + folder.path("r");  // few nodes in time to verify
  REQUIRE(arcslip_program("study " + words).status == 0);
  REQUIRE(report(folder.path("r")).status == 0);
  CHECK_FALSE(data_in(folder.path("r")).contains("run"));
  CHECK(data_in(folder.path("r"))["study"].contains("sweep"));
  REQUIRE(arcslip_program("run " + words + " --verify").status == 0);
  REQUIRE(report(folder.path("r")).status == 0);
  const json both = data_in(folder.path("r"));
  CHECK(both["study"]["answer"][0].get<std::string>().starts_with("Best preload P = "));
  CHECK(both["run"]["answer"][0].get<std::string>().starts_with("Highest peak Y = "));
  CHECK(both["run"]["verified"]["rows"] > 0);
  CHECK_FALSE(both["run"]["summary"].contains("study"));
}

TEST_CASE("A title cannot end the data of a page, nor begin markup", "[report]") {
  if (!has_plotly()) return;
  const TemporaryFolder folder;
  const std::string title = "</script><script>alert(1)</script><!--";
  const std::string file = folder.write("case.toml", "title = '" + title +
                                                         "'\n[system]\nmodel = 'cusp'\n[branch]\n"
                                                         "parameter = 'mu'\nfrom = -2\nto = 2\n");
  REQUIRE(arcslip_program("run " + file + " --quiet -o " + folder.path("r")).status == 0);
  REQUIRE(report(folder.path("r")).status == 0);
  CHECK(data_in(folder.path("r"))["run"]["summary"]["title"] == title);
  CHECK(read(folder.path("r/report.html")).find("alert(1)</script>") == std::string::npos);
}

TEST_CASE("report says of a surface that plot draws it", "[report]") {
  const TemporaryFolder folder;
  REQUIRE(arcslip_program("run " + source_folder() + "/problems/tank_surface.toml --quiet -o " +
                          folder.path("tank"))
              .status == 0);
  const Outcome outcome = report(folder.path("tank"));
  CHECK(outcome.status == 1);
  CHECK(is_one_line(outcome.err));
  CHECK_THAT(outcome.err, ContainsSubstring("arcslip plot draws it"));
}

TEST_CASE("report refuses a folder without results, in one line that names the file", "[report]") {
  const TemporaryFolder folder;
  run_figure_8(folder, "whole");
  const std::string table = read(folder.path("whole/branches.csv"));
  const std::string summary = read(folder.path("whole/summary.json"));
  const auto refuses = [&](const std::string& name, const std::string& csv, const std::string& text,
                           const std::string& reason) {
    CAPTURE(name);
    fs::create_directories(folder.path(name));
    if (!csv.empty()) folder.write(name + "/branches.csv", csv);
    if (!text.empty()) folder.write(name + "/summary.json", text);
    const Outcome outcome = report(folder.path(name));
    CHECK(outcome.status == 1);
    CHECK(is_one_line(outcome.err));
    CHECK_THAT(outcome.err, ContainsSubstring(folder.path(name)) && ContainsSubstring(reason));
    CHECK_FALSE(fs::exists(folder.path(name + "/report.html")));
  };
  refuses("empty", "", "", "summary.json: cannot be read");
  refuses("no table", "", summary, "branches.csv: cannot be read");
  refuses("header only", table.substr(0, table.find('\n') + 1), summary, "holds no points");
  refuses("half a line", table.substr(0, table.size() - 60), summary, "fields; expected");
  refuses("half a summary", table, summary.substr(0, summary.size() / 2), "is not JSON");
  refuses("another summary", table, "[1, 2]", "is not a summary");
  json older = json::parse(summary);
  older["arcslip"] = "0.3.0";
  older.erase("branches");
  refuses("older summary", table, older.dump(), R"(results are of arcslip "0.3.0")");
  older = json::parse(summary);
  older["arcslip"] = "0.3.0";
  refuses(
      "older table", "branch,point\n0,0\n", older.dump(),
      R"(has no column type; expected a table that arcslip has written (the results are of arcslip "0.3.0")");

  const Outcome outcome = report(folder.path("none"));
  CHECK(outcome.status == 1);
  CHECK(is_one_line(outcome.err));
  CHECK_THAT(outcome.err, ContainsSubstring(folder.path("none") + ": is not a folder"));
}

TEST_CASE("report says in one line what is missing beside the program, and how to get it", "[report]") {
  const TemporaryFolder folder;
  run_figure_8(folder, "r");
  const auto fails = [&](bool plots, const std::string& message) {
    const TemporaryFolder place;
    const Outcome outcome = shell(program_with(place, plots) + " report " + folder.path("r"));
    CHECK(outcome.status == 4);
    CHECK(is_one_line(outcome.err));
    CHECK_THAT(outcome.err, ContainsSubstring(message));
    CHECK(names_in(folder.path("r")) == run_results);
  };
  fails(
      true,
      "plotly-basic.min.js: plotly.js, which draws the pictures, was not found; put plotly-basic.min.js of");
  fails(false, "report.html: a part of the report is missing; install arcslip anew");
}

TEST_CASE("report says in one line that its page cannot be written", "[report]") {
  if (!has_plotly()) return;
  const TemporaryFolder folder;
  run_figure_8(folder, "r");
  fs::create_directories(folder.path("r/report.html/inside"));
  const Outcome outcome = report(folder.path("r"));
  CHECK(outcome.status == 4);
  CHECK(is_one_line(outcome.err));
  CHECK_THAT(outcome.err, ContainsSubstring("report.html: cannot be written"));
}
