// What the program says, and where it says it: one line, no control characters, no more than is needed.

#include <algorithm>

#include <nlohmann/json.hpp>

#include "arcslip/cases/case_file.hpp"
#include "arcslip/results/results.hpp"
#include "catch.hpp"
#include "program.hpp"
#include "study_text.hpp"

using namespace arcslip::testing;

namespace {

const std::string rods =
    "[system]\nmodel = 'rods'\nwave_number = 1\nelements = 30\nmass_ratio = 5.0\nfrequency_ratio = 4.0\n"
    "interface_stiffness = 1000.0\nforce = 1.0\npreload = 1.0\n";
const std::string over_eta = "[branch]\nparameter = 'eta'\nfrom = 3.0\nto = 4.0\n";

bool is_clean(const std::string& text) {
  return std::all_of(text.begin(), text.end(),
                     [](unsigned char c) { return c == '\n' || (c >= 0x20 && c != 0x7f); });
}

/// Refused with status 1, in one short line that names the file.
std::string refused(const Outcome& outcome, const std::string& path) {
  INFO(outcome.err.substr(0, 1000));
  CHECK(outcome.status == 1);
  CHECK(is_one_line(outcome.err));
  CHECK(is_clean(outcome.err));
  CHECK(outcome.err.size() < 1000);
  CHECK_THAT(outcome.err, ContainsSubstring(path));
  return outcome.err;
}

}  // namespace

TEST_CASE("The status is the same where nobody can be told", "[messages]") {
  const TemporaryFolder folder;
  const std::string cut = "'" + program + "' run " + figure_8_case + " --quiet -o " + folder.path("r") +
                          " --set continuation.max_points=50";
  const std::string failed = "'" + program + "' study " + folder.write("case.toml", study_text) +
                             " --quiet -o " + folder.path("s") + " --set continuation.max_points=5";
  for (const std::string nobody : {"2>/dev/full", "2>&-", "2>&- >&- <&-"}) {
    CAPTURE(nobody);
    CHECK(shell(cut + " " + nobody).status == 3);
    CHECK(shell(failed + " " + nobody).status == 3);
    CHECK(shell("'" + program + "' check /nowhere " + nobody).status == 1);
    CHECK(shell("'" + program + "' --nonsense " + nobody).status == 2);
  }
  CHECK(read_csv(folder.path("r/branches.csv")).size() == 1 + 5 * 50);
}

TEST_CASE("What cannot be printed has status 4 wherever it is printed, and results are written all the same",
          "[messages]") {
  const TemporaryFolder folder;
  const std::string study = folder.write("case.toml", study_text);
  const std::string results = folder.path("r");
  REQUIRE(
      arcslip_program("run " + figure_8_case + " --quiet -o " + results + " --set branch.to=1.5").status ==
      0);
  for (const std::string& command :
       {std::string("--help"), std::string("run --help"), std::string("sector ring --help"),
        std::string("--version"), "check " + figure_8_case, "check " + study,
        "run " + figure_8_case + " -o " + folder.path("a"),
        "run " + figure_8_case + " --certify -o " + folder.path("b") + " --set branch.to=1.5",
        "study " + study + " -o " + folder.path("c"),
        "sector ring --elements 2 --ring-elements 2 -o " + folder.path("d")}) {
    for (const std::string nowhere : {">/dev/full", ">&-"}) {
      CAPTURE(command, nowhere);
      const Outcome outcome = shell("'" + program + "' " + command + " " + nowhere);
      CHECK(outcome.status == 4);
      CHECK(is_one_line(outcome.err));
      CHECK_THAT(outcome.err, ContainsSubstring("standard output: cannot be written"));
    }
  }
  CHECK(names_in(folder.path("a")) == std::set<std::string>{"branches.csv", "curves.csv", "summary.json"});
  CHECK(read(folder.path("a/branches.csv")).starts_with("branch,point,"));
  CHECK(names_in(folder.path("c")) ==
        std::set<std::string>{"optimum.csv", "study.sqlite", "summary.json", "sweep.csv"});
  // What is incomplete besides is said.
  const Outcome both = shell("'" + program + "' run " + figure_8_case + " -o " + folder.path("a") +
                             " --set continuation.max_points=50 >/dev/full");
  CHECK(both.status == 4);
  CHECK_THAT(both.err, ContainsSubstring("branch 4: max_points") && ContainsSubstring("standard output"));
}

TEST_CASE("Keys, values, names and titles do not reach a terminal as it would obey them", "[messages]") {
  const TemporaryFolder folder;
  const std::string nasty = "\\u001b[2J\\n\\u009b\\u202e";
  const auto path = [&](const std::string& text) { return folder.write("case.toml", text); };
  const auto check = [&](const std::string& text) { return arcslip_program("check " + path(text)); };
  CHECK_THAT(refused(check("\"" + nasty + "\" = 1\n"), "case.toml:1:"),
             ContainsSubstring("\\x1b[2J\\n\\u009b\\u202e: unknown key"));
  CHECK_THAT(refused(check("[system]\nmodel = \"" + nasty + "\"\n" + over_eta), "case.toml:2:9: "),
             ContainsSubstring("got \"\\x1b[2J\\n\\u009b\\u202e\""));
  refused(check("[system]\n\"" + nasty + "\" = 1\n" + rods.substr(9) + over_eta), "case.toml:");
  refused(check(rods + over_eta + "for_each = { \"" + nasty + "\" = [1] }\n"), "case.toml:");
  refused(check(rods + over_eta + "extrema_of = [\"" + nasty + "\"]\n"), "case.toml:");
  refused(check(rods + over_eta + "[continuation]\nstop_after = \"" + nasty + "\"\n"), "case.toml:");
  refused(check(rods + over_eta + "[continuation]\nstop_after = { \"" + nasty + "\" = 1 }\n"), "case.toml:");
  refused(check(rods + "damping = { \"" + nasty + "\" = 1 }\n" + over_eta), "case.toml:");
  refused(check("a = 1\x1b\n"), "case.toml:1:");
  refused(check("a = \xff\n"), "case.toml:");

  const std::string raw = "$(printf '\\033[2J\\nx')";
  refused(arcslip_program("check \"/nowhere/" + raw + "\""), "/nowhere/\\x1b[2J");
  refused(arcslip_program("check " + figure_8_case + " --set \"" + raw + "=1\""), "--set \\x1b[2J");
  refused(arcslip_program("check " + figure_8_case + " --set \"system.force=" + raw + "\""),
          "--set system.force=");
  refused(arcslip_program("plot \"/nowhere/" + raw + "\""), "/nowhere/\\x1b[2J");
  const Outcome wrong = arcslip_program("check a b \"" + raw + "\"");
  CHECK(wrong.status == 2);
  CHECK(is_one_line(wrong.err));
  CHECK(is_clean(wrong.err));

  const std::string titled = path("title = \"" + nasty + "\"\n" + rods + over_eta);
  for (const std::string& command :
       {"check " + titled, "run " + titled + " -o \"" + folder.path("") + "r" + raw + "\""}) {
    const Outcome outcome = arcslip_program(command);
    CHECK(outcome.status == 0);
    CHECK(is_clean(outcome.out));
    CHECK_THAT(outcome.out, ContainsSubstring("\\x1b[2J\\n\\u009b\\u202e\n"));
  }
}

TEST_CASE("Of a long text a message shows the beginning", "[messages]") {
  const TemporaryFolder folder;
  const std::string megabyte(1'000'000, 'x');
  const auto check = [&](const std::string& text) {
    return arcslip_program("check " + folder.write("case.toml", text));
  };
  CHECK_THAT(
      refused(check("[system]\nmodel = \"" + megabyte + "\"\n" + over_eta), "case.toml:2:9: system.model"),
      ContainsSubstring("... (1000000 bytes)"));
  refused(check(megabyte + " = 1\n"), "xxx");
  refused(check(megabyte + "\n"), "case.toml:1:");
  refused(check(rods + over_eta + "for_each = { " + megabyte + " = [1] }\n"), "case.toml:14:");
  refused(check(rods + over_eta + "[continuation]\nstop_after = \"" + megabyte + "\"\n"), "case.toml:15:");
  refused(check(rods + over_eta + "[continuation]\nstop_after = { " + megabyte + " = 1 }\n"),
          "case.toml:15:");
  const Outcome titled = check("title = \"" + megabyte + "\"\n" + rods + over_eta);
  CHECK(titled.status == 0);
  CHECK(titled.out.size() < 1000);
}

TEST_CASE("What fails where a problem is built names the file and what asked for it", "[messages]") {
  const TemporaryFolder folder;
  const auto answers = [&](const std::string& text) {
    const std::string path = folder.write("case.toml", text);
    const std::string one = refused(arcslip_program("check " + path), "case.toml:");
    CHECK(refused(arcslip_program("run " + path + " -o " + folder.path("r")), "case.toml:") == one);
    CHECK_FALSE(std::filesystem::exists(folder.path("r")));
    return one;
  };
  // Each number is allowed, but not together.
  const auto with = [&](const std::string& key, const std::string& value) {
    std::string text = rods;
    const std::size_t at = text.find(key + " = ");
    text.replace(at, text.find('\n', at) - at, key + " = " + value);
    return text + over_eta;
  };
  CHECK_THAT(
      answers(with("frequency_ratio", "1e160")),
      ContainsSubstring("case.toml:1:1: system: expected numbers") && ContainsSubstring("K* = gamma^2 M*"));
  CHECK_THAT(answers(with("interface_stiffness", "1e-307")), ContainsSubstring("k = K_FD/N"));
  CHECK_THAT(answers(with("preload", "1e-308")), ContainsSubstring("S = P K*/K_FD"));
  for (const char* preload : {"1e-305", "1e-160", "1e160"})
    CHECK_THAT(answers(with("preload", preload)),
               ContainsSubstring("give a S^2, to which energies are related,"));
  CHECK_THAT(answers(with("force", "1e307")), ContainsSubstring("F K*"));
  CHECK_THAT(answers(with("preload", "1e-308") + "[system.damping]\nbase = 1e-3\n"),
             ContainsSubstring("system: "));
}

TEST_CASE("A branch that no problem can be built for is named, and the others are traced", "[messages]") {
  const TemporaryFolder folder;
  REQUIRE(
      arcslip_program("sector ring -o " + folder.path("ring") + " --elements 2 --ring-elements 2").status ==
      0);
  // Where the square of eta is beyond a double the sector cannot be reduced.
  const std::string windows =
      " --set branch.for_each='[{ reduction_window = [1600, 2200] }, { reduction_window = [1e150, 1e160] }]'";
  const std::string why = ", where w*^2 M is beyond the range of a double";
  const Outcome outcome =
      arcslip_program("run " + folder.path("ring/case.toml") + " --quiet -o " + folder.path("r") + windows);
  CHECK(outcome.status == 3);
  CHECK(is_one_line(outcome.err));
  CHECK_THAT(outcome.err, ContainsSubstring(folder.path("ring/case.toml:")) && ContainsSubstring(why) &&
                              ContainsSubstring("(branch 1: reduction_window = "));
  const auto summary = nlohmann::json::parse(read(folder.path("r/summary.json")));
  REQUIRE(summary["branches"].size() == 2);
  CHECK(summary["branches"][0]["stop"] == "reached_end");
  CHECK(summary["branches"][1]["stop"] == "no_start");
  CHECK_THAT(summary["branches"][1]["explanation"].get<std::string>(), ContainsSubstring(why));
  CHECK(read_csv(folder.path("r/branches.csv")).size() ==
        1 + summary["branches"][0]["points"].get<std::size_t>());

  for (const std::string command : {"check", "run", "study"}) {
    const Outcome first = arcslip_program(command + " " + folder.path("ring/case.toml") +
                                          " --set system.reduction_window=[1e150,1e160]" +
                                          (command == "check" ? "" : " -o " + folder.path("none")));
    refused(first, why);
    CHECK_FALSE(std::filesystem::exists(folder.path("none")));
  }
}

TEST_CASE("Very many branches are checked in little memory, and few of them are shown", "[messages]") {
#ifdef __SANITIZE_ADDRESS__
  const std::string in_little = "";  // the sanitizer reserves more than there is
#else
  const std::string in_little = "ulimit -v 250000; ";  // kB, of which a branch had one to itself
#endif
  const TemporaryFolder folder;
  const std::string many = "for_each = { preload = { from = 0.1, to = 100.0, count = 300000 } }\n";
  const Outcome outcome =
      shell(in_little + "'" + program + "' check " + folder.write("case.toml", rods + over_eta + many));
  CHECK(outcome.status == 0);
  CHECK(outcome.out.size() < 30'000);
  CHECK_THAT(outcome.out, ContainsSubstring("branch 98: ") && ContainsSubstring("... and 299901 more") &&
                              ContainsSubstring("branch 299999: preload = 100.0"));
}

TEST_CASE("Branches with columns of their own stand in one table as if all had been known", "[messages]") {
  const TemporaryFolder folder;
  const std::string path =
      folder.write("case.toml", rods + over_eta + "for_each = { harmonics = [3, 1, 5, 3] }\n");
  REQUIRE(arcslip_program("run " + path + " --quiet -o " + folder.path("r")).status == 0);
  const arcslip::Case input = arcslip::read_case(path);
  std::vector<arcslip::TracedBranch> traced;
  for (const arcslip::CaseBranch& request : input.branches) traced.push_back(arcslip::trace(request).front());
  std::string whole;
  arcslip::write_branches(traced, [&](std::string_view piece) { whole += piece; });
  CHECK(read(folder.path("r/branches.csv")) == whole);
  CHECK(nlohmann::json::parse(read(folder.path("r/summary.json")))["branches"].size() == 4);
}
