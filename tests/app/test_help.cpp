// What the program tells of itself and of the keys of case files.

#include <sstream>

#include "catch.hpp"
#include "places.hpp"
#include "program.hpp"

using namespace arcslip::testing;

TEST_CASE("Help and version explain the program with status 0") {
  const std::string version = arcslip_program("--version").out;
  CHECK_THAT(version, ContainsSubstring("arcslip 0."));
  CHECK_THAT(version, ContainsSubstring("blas") && (ContainsSubstring("METIS") || ContainsSubstring("AMD")));
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

TEST_CASE("A command that is none is answered with the nearest one") {
  const Outcome near = arcslip_program("rnu case.toml");
  CHECK(near.status == 2);
  CHECK(near.err == "arcslip: unknown command 'rnu'; did you mean 'run'?\n");
  const Outcome far = arcslip_program("zzzzzzzz");
  CHECK(far.status == 2);
  CHECK(is_one_line(far.err));
  CHECK_THAT(far.err, ContainsSubstring("see arcslip --help"));
}

TEST_CASE("help tells of a command what its --help does, no line wider than 100 columns") {
  for (const std::string command : {"run", "study", "check", "plot", "report", "help"}) {
    INFO(command);
    const Outcome help = arcslip_program("help " + command);
    CHECK(help.status == 0);
    const Outcome own = arcslip_program(command + " --help");
    CHECK(help.out == own.out);
    std::istringstream lines(help.out);
    for (std::string line; std::getline(lines, line);) CHECK(line.size() <= 100);
  }
}

TEST_CASE("A case of the other command says which one it is for") {
  const std::string problems = source_folder() + "/problems/";
  const Outcome run = arcslip_program("run " + problems + "figure_12.toml");
  CHECK(run.status == 1);
  CHECK_THAT(run.err, ContainsSubstring("section [branch]") && ContainsSubstring("arcslip study"));
  const Outcome study = arcslip_program("study " + problems + "figure_8.toml");
  CHECK(study.status == 1);
  CHECK_THAT(study.err, ContainsSubstring("section [study]") && ContainsSubstring("arcslip run"));
}
