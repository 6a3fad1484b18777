#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <csignal>
#include <map>
#include <new>
#include <sstream>

#include "app/command.hpp"
#include "app/commands.hpp"
#include "app/freed_memory.hpp"
#include "app/interrupt.hpp"
#include "app/wrap.hpp"
#include "arcslip/cases/case_file.hpp"
#include "arcslip/version.hpp"
#include "keys/printable.hpp"
#include "keys/toml_reader.hpp"
#include "results/output.hpp"
#include "sectors/dense_blocks.hpp"
#include "sectors/elimination.hpp"

namespace {

constexpr const char* about =
    "arcslip traces the response of structures damped by dry friction: continuation through stick, slip and "
    "folds.";

constexpr const char* examples = R"(
Examples
  arcslip run problems/figure_8.toml              results in out/figure_8
  arcslip run problems/figure_8.toml -o fine --set continuation.max_step=0.02
  arcslip run problems/figure_8.toml --certify    and a proof that nothing was jumped
  arcslip plot out/figure_8                       its pictures, PNG and SVG
  arcslip report out/figure_8                     a page to send, with pictures to zoom: out/figure_8/report.html
  arcslip check problems/figure_8.toml            what would run
  arcslip check problems/enz.toml --derivatives   and whether the problem's derivatives are exact
  arcslip run problems/rotor_ring.toml            a system given in SI units
  arcslip run problems/ridge.toml                 the peaks over the preload: a curve in two parameters
  arcslip help stop_after                         what a key of a case file means
  arcslip study problems/chart.toml               the best preload of each of 400 designs
  arcslip sector plate -o rotor                   finite-element matrices of a brake rotor and its ring

Exit status
  0  done
  1  wrong input
  2  wrong command line
  3  a branch was not traced, or a study not made, to its end, or a branch not certified, or an interrupt
  4  a file or standard output could not be written)";

/// Why a word in the place of a command is none; empty where it is one, or no word.
std::string unknown_command(const std::string& word) {
  using namespace arcslip;
  if (word.empty() || is_command(word) || word == "-h" || word == "--help" || word == "--version") return "";
  if (word.front() == '-')
    return "arcslip: unknown option '" + printable(word, longest_name) + "'; see arcslip --help";
  std::vector<std::string> names;
  for (const Command& command : commands()) names.push_back(command.name);
  const std::string meant = nearest_name(word, names);
  return "arcslip: unknown command '" + printable(word, longest_name) + "'; " +
         (meant.empty() ? "see arcslip --help" : "did you mean '" + meant + "'?");
}

int dispatch(int argc, char** argv) {
  using namespace arcslip;
  if (const std::string wrong = argc > 1 ? unknown_command(argv[1]) : ""; !wrong.empty()) {
    complain(wrong);
    return status::wrong_command_line;
  }
  CLI::App app{about, "arcslip"};
  app.set_version_flag("--version", fmt::format("arcslip {}\nsectors: blocks by {}, order by {}", release,
                                                dense::library(), least_fill_library()));
  app.require_subcommand(1);
  app.footer(examples);

  std::map<std::string, Command::Action> actions;
  for (const Command& command : commands()) actions[command.name] = command.add(app);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() != 0) {
      complain(std::string("arcslip: ") + error.what() + "; see arcslip --help");
      return status::wrong_command_line;
    }
    std::ostringstream asked_for;  // --help, --version
    app.exit(error, asked_for);
    print(wrapped(asked_for.str()));
    return status::done;
  }
  return actions.at(app.get_subcommands().front()->get_name())();
}

}  // namespace

void arcslip::add_settings(CLI::App* command, std::vector<std::string>& settings) {
  command->add_option("--set", settings, "Replace a value of the case file; may be repeated")
      ->type_name("section.key=value")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
      ->allow_extra_args(false);
}

CLI::Option* arcslip::add_folder(CLI::App* command, const std::string& option, std::string& folder,
                                 const std::string& help) {
  return command->add_option(option, folder, help)
      ->type_name("DIR")
      ->check([](const std::string& name) -> std::string {
        return name.empty() ? "expected the name of a folder, got ''" : "";
      });
}

CLI::Option* arcslip::add_results_folder(CLI::App* command, std::string& folder) {
  return add_folder(command, "-o,--output", folder, "Folder for the results; out/<case> if not given");
}

CLI::Validator arcslip::positive_number() {
  const auto wrong = [](const std::string& number) -> std::string {
    double value = 0;
    const bool is_positive = CLI::detail::lexical_cast(number, value) && value > 0 && std::isfinite(value);
    return is_positive ? "" : "expected a number > 0, got '" + printable(number, longest_name) + "'";
  };
  return {wrong, "POSITIVE"};
}

void arcslip::warn(const std::vector<std::string>& warnings) {
  for (const std::string& warning : warnings) complain("arcslip: warning: " + warning);
}

int arcslip::guarded(const std::function<int()>& command) {
  try {
    return command();
  } catch (const InputError& error) {
    complain(error.what());
    return status::wrong_input;
  } catch (const OutputError& error) {
    complain(error.what());
    return status::cannot_write;
  } catch (const Interrupted&) {
    complain("arcslip: interrupted");
    return status::incomplete_branch;
  } catch (const std::bad_alloc&) {
    complain("arcslip: there is not enough memory");
    return status::wrong_input;
  } catch (const std::exception& error) {
    complain(std::string("arcslip: ") + error.what());
    return status::wrong_input;
  }
}

int main(int argc, char** argv) {
  arcslip::keep_standard_streams();
  arcslip::keep_freed_memory();
#ifdef SIGXFSZ
  std::signal(SIGXFSZ, SIG_IGN);  // a file over the size limit is reported as one that cannot be written
#endif
  std::signal(SIGPIPE, SIG_IGN);
  return arcslip::guarded([&] { return dispatch(argc, argv); });
}
