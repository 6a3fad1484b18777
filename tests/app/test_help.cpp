// What the program tells of itself and of the keys of case files.

#include "catch.hpp"
#include "program.hpp"

using namespace arcslip::testing;

TEST_CASE("Help and version explain the program with status 0") {
  CHECK_THAT(arcslip_program("--version").out, ContainsSubstring("arcslip 0."));
  const Outcome help = arcslip_program("--help");
  CHECK(help.status == 0);
  for (const std::string word : {"run", "check", "plot", "Exit status", "Examples"}) {
    CHECK_THAT(help.out, ContainsSubstring(word));
  }
  CHECK_THAT(arcslip_program("run --help").out, ContainsSubstring("--set") && ContainsSubstring("for_each") &&
                                                    ContainsSubstring("curve = \"peak\"") &&
                                                    ContainsSubstring("stop_after") &&
                                                    ContainsSubstring("limit_cycle"));
}

TEST_CASE("help lists the keys of case files and tells all of one, or the nearest to it") {
  const Outcome all = arcslip_program("help");
  CHECK(all.status == 0);
  CHECK_THAT(all.out, ContainsSubstring("[study.uncertain]") && ContainsSubstring("damper.width") &&
                          ContainsSubstring("lorenz84.G"));
  const Outcome one = arcslip_program("help continuation.max_step");
  CHECK(one.status == 0);
  CHECK(one.out ==
        "continuation.max_step: largest step\n  is            number > 0 and <= 1\n"
        "  unit          scaled arclength\n  if not given  0.1\n");
  CHECK_THAT(arcslip_program("help eta").out,
             ContainsSubstring("branch.eta: ") && ContainsSubstring("study.eta: "));
  CHECK_THAT(arcslip_program("help preload").out,
             ContainsSubstring("continued as  P\n") && ContainsSubstring("may list it\n"));
  const Outcome none = arcslip_program("help continuation.max_stop");
  CHECK(none.status == 2);
  CHECK(is_one_line(none.err));
  CHECK_THAT(none.err, ContainsSubstring("did you mean 'max_step'?"));
}

TEST_CASE("The manual page is read without a warning and names every command") {
  const TemporaryFolder folder;
  const std::string page = folder.write("arcslip.1", arcslip_program("help --man").out);
  const Outcome read_page = shell("LC_ALL=C.UTF-8 MANWIDTH=80 man --warnings -l '" + page + "'");
  CHECK(read_page.status == 0);
  CHECK(read_page.err.empty());
  for (const std::string word : {"NAME", "arcslip - trace", "study", "report", "KEYS OF CASE FILES"}) {
    CHECK_THAT(read_page.out, ContainsSubstring(word));
  }
}

TEST_CASE("bash completes commands, options, case files and keys") {
  const TemporaryFolder folder;
  const std::string script = folder.write("arcslip", arcslip_program("help --completion bash").out);
  const Outcome syntax = shell("bash -n '" + script + "'");
  CHECK(syntax.status == 0);
  CHECK(syntax.err.empty());
  folder.write("mine.toml", "");
  folder.write("mine.txt", "");
  // What bash does at the tab key with these words, the last of them begun.
  const auto completed = [&](const std::string& words) {
    const std::string lines =
        "compopt() { :; }\ncd '" + folder.path("") + "'\nsource ./arcslip\nCOMP_WORDS=(" + words +
        ")\nCOMP_CWORD=$((${#COMP_WORDS[@]} - 1))\n_arcslip\n" + "printf '%s\\n' \"${COMPREPLY[@]}\"\n";
    const Outcome outcome = shell("bash '" + folder.write("tab", lines) + "'");
    CHECK(outcome.err.empty());
    return outcome.out;
  };
  CHECK(completed("arcslip stu") == "study\n");
  CHECK(completed("arcslip run --verif") == "--verify\n");
  CHECK(completed("arcslip run min") == "mine.toml\n");
  CHECK(completed("arcslip run --set system.wave_n") == "system.wave_number=\n");
  CHECK(completed("arcslip help continuation.max_step") == "continuation.max_step\n");
}
