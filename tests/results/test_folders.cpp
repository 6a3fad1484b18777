// Folders that hold the results of several commands, one after the other or at once.

#include <nlohmann/json.hpp>

#include "background.hpp"
#include "catch.hpp"
#include "plotting.hpp"
#include "results/atomic_file.hpp"
#include "results/output_folder.hpp"
#include "study_text.hpp"

using namespace arcslip::testing;

namespace {

/// A run and a study of one case file.
const std::string both =
    study_text + "[branch]\nparameter = \"eta\"\nfrom = 3.0\nto = 5.0\nfor_each = { preload = [1] }\n";

nlohmann::json summary_in(const TemporaryFolder& folder) {
  return nlohmann::json::parse(read(folder.path("r/summary.json")));
}

}  // namespace

TEST_CASE("The summaries of a run and of a study stand beside each other, whichever came first",
          "[folders]") {
  const TemporaryFolder folder;
  const std::string words = folder.write("case.toml", both) + " --quiet -o " + folder.path("r");
  const auto has_both = [&] {
    const auto summary = summary_in(folder);
    CHECK(summary["branches"].size() == 1);
    CHECK(summary["case"].contains("branch"));
    CHECK_FALSE(summary["case"].contains("study"));
    CHECK(summary["study"]["designs"] == 1);
    CHECK(summary["study"]["case"].contains("study"));
  };
  REQUIRE(arcslip_program("study " + words).status == 0);
  CHECK(summary_in(folder)["designs"] == 1);
  REQUIRE(arcslip_program("run " + words).status == 0);
  has_both();
  REQUIRE(arcslip_program("run " + words).status == 0);
  has_both();
  REQUIRE(arcslip_program("study " + words).status == 0);
  has_both();
  if (!has_matplotlib()) return;
  const Outcome outcome = arcslip_program("plot " + folder.path("r") + " --format svg");
  CHECK(outcome.err.empty());
  CHECK(outcome.status == 0);
  require_pictures(
      folder.path("r"), 2'000,
      {"amplitude", "relative", "phases", "phase_difference", "dissipated", "ratio", "peaks"},
      {"branches.csv", "curves.csv", "summary.json", "optimum.csv", "sweep.csv", "study.sqlite"});
}

TEST_CASE("A study that is begun anew forgets the former one, and leaves a run's summary", "[folders]") {
  const TemporaryFolder folder;
  const std::string words = folder.write("case.toml", both) + " --quiet -o " + folder.path("r");
  REQUIRE(arcslip_program("run " + words).status == 0);
  REQUIRE(arcslip_program("study " + words).status == 0);
  // It fails before it has an optimum.
  CHECK(shell("ulimit -f 40; '" + program + "' study " + words).status == 4);
  CHECK_FALSE(summary_in(folder).contains("study"));
  CHECK(summary_in(folder)["branches"].size() == 1);
}

TEST_CASE("A verification of other branches does not stay beside those of a run", "[folders]") {
  const TemporaryFolder folder;
  const std::string words = "run " + case_named("figure_8") + " --quiet -o " + folder.path("r");
  REQUIRE(arcslip_program(words).status == 0);
  folder.write("r/verify.csv", "of other branches");
  // A run that writes nothing leaves what there is.
  CHECK(shell("ulimit -f 100; '" + program + "' " + words).status == 4);
  CHECK(names_in(folder.path("r")).contains("verify.csv"));
  REQUIRE(arcslip_program(words).status == 0);
  CHECK(names_in(folder.path("r")) == std::set<std::string>{"branches.csv", "curves.csv", "summary.json"});
}

TEST_CASE("A folder's name is no more than a name", "[folders]") {
  const TemporaryFolder folder;
  const std::string path = folder.write("case.toml", study_text);
  for (const std::string name : {"file:results", "file:results?mode=memory", ":memory:", "a%20b#c"}) {
    CAPTURE(name);
    const Outcome outcome =
        shell("cd " + folder.path("") + " && '" + program + "' study " + path + " --quiet -o '" + name + "'");
    CHECK(outcome.status == 0);
    CHECK(names_in(folder.path(name)) ==
          std::set<std::string>{"optimum.csv", "study.sqlite", "summary.json", "sweep.csv"});
  }
}

TEST_CASE("Two programs do not write to one folder at once", "[folders]") {
  const TemporaryFolder folder;
  const std::string path = folder.write("case.toml", chart_text);
  Background first({"study", path, "--quiet", "-o", folder.path("r"), "--set",
                    "study.for_each.frequency_ratio.count=100000"});
  REQUIRE(first.wait_until([&] { return std::filesystem::exists(folder.path("r/study.sqlite")); }));
  const Outcome outcome = arcslip_program("study " + path + " --quiet -o " + folder.path("r"));
  CHECK(outcome.status == 4);
  CHECK_THAT(outcome.err,
             ContainsSubstring(folder.path("r") + ": cannot be written: another arcslip is writing there"));
  {
    const arcslip::OutputFolder held(folder.path("s"));
    const Outcome blocked = arcslip_program("run " + case_named("figure_8") + " -o " + folder.path("s"));
    CHECK(blocked.status == 4);
    CHECK(is_one_line(blocked.err));
  }
  CHECK(arcslip_program("run " + case_named("figure_8") + " --quiet -o " + folder.path("s")).status == 0);
}

TEST_CASE("A file has no name before it is whole, and then replaces what had it", "[folders]") {
  const TemporaryFolder folder;
  folder.write("table.csv", "old");
  {
    arcslip::AtomicFile file(folder.path("table.csv"));
    file.write("first\nsecond");
    CHECK(names_in(folder.path("")) == std::set<std::string>{"table.csv"});
    std::vector<std::string> lines;
    file.for_each_line([&](std::string_view line) { lines.emplace_back(line); });
    CHECK(lines == std::vector<std::string>{"first", "second"});
    arcslip::AtomicFile other(folder.path("table.csv"));
    other.write("another");
    CHECK(read(folder.path("table.csv")) == "old");
    file.write("\n");
    file.commit();
  }
  CHECK(names_in(folder.path("")) == std::set<std::string>{"table.csv"});
  CHECK(read(folder.path("table.csv")) == "first\nsecond\n");
  {
    using arcslip::AtomicFile;
    AtomicFile first(folder.path("table.csv"), AtomicFile::Hidden::under_temporary_name);
    AtomicFile second(folder.path("table.csv"), AtomicFile::Hidden::under_temporary_name);
    CHECK(names_in(folder.path("")).size() == 3);
    second.write("second");
    second.commit();
    CHECK(names_in(folder.path("")).size() == 2);
  }
  CHECK(names_in(folder.path("")) == std::set<std::string>{"table.csv"});
  CHECK(read(folder.path("table.csv")) == "second");
  std::filesystem::create_directory(folder.path("folder.csv"));
  CHECK_THROWS_WITH(arcslip::AtomicFile(folder.path("folder.csv")), ContainsSubstring("Is a directory"));
}

TEST_CASE("Of a run and a study what can be drawn is drawn", "[folders]") {
  if (!has_matplotlib()) return;
  const TemporaryFolder folder;
  const std::string words = folder.write("case.toml", both) + " --quiet -o " + folder.path("r");
  REQUIRE(arcslip_program("run " + words).status == 0);
  // A design alone without its peaks over the preload gives no picture.
  REQUIRE(arcslip_program("study " + words + " --set study.sweep=false").status == 0);
  const Outcome outcome = arcslip_program("plot " + folder.path("r") + " --format svg");
  CHECK(outcome.err.empty());
  CHECK(outcome.status == 0);
  require_pictures(folder.path("r"), 2'000,
                   {"amplitude", "relative", "phases", "phase_difference", "dissipated"},
                   {"branches.csv", "curves.csv", "summary.json", "optimum.csv", "study.sqlite"});
}
