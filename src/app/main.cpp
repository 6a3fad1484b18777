#include <CLI/CLI.hpp>
#include <csignal>
#include <new>
#include <sstream>

#include "app/command_sector.hpp"
#include "app/commands.hpp"
#include "app/interrupt.hpp"
#include "arcslip/cases/case_file.hpp"
#include "arcslip/version.hpp"
#include "results/output.hpp"

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
  arcslip check problems/figure_8.toml            what would run
  arcslip check problems/enz.toml --derivatives   and whether the problem's derivatives are exact
  arcslip run problems/rotor_ring.toml            a system given in SI units
  arcslip run problems/ridge.toml                 the peaks over the preload: a curve in two parameters
  arcslip help stop_after                         what a key of a case file means
  arcslip study problems/chart.toml               the best preload of each of 400 designs
  arcslip sector plate -o rotor                   finite-element matrices of a brake rotor and its ring

Exit status
  0 done; 1 wrong input; 2 wrong command line; 3 a branch was not traced, or a study not made, to its end, or a branch not certified,
  or an interrupt; 4 a file or standard output could not be written)";

constexpr const char* run_notes = R"(
Writes DIR/branches.csv (one row for each point), DIR/curves.csv (more rows in between, for pictures), DIR/summary.json
(special points, why each branch ended) and prints the special points. Branches are written as they come. Ctrl-C ends a run cleanly: what was traced is written and marked
as interrupted, with DIR/run.checkpoint, from which --resume DIR goes on to the same tables; so it does where max_seconds
were too few.

A curve of peaks in two parameters: curve = "peak", parameters = ["eta", "P"], window = [0.5, 120.0] of eta, from = 0.1 and
to = 100.0 of P. A case file has these keys, of which `arcslip help KEY` tells more; problems/figure_8.toml is one:

)";

constexpr const char* study_notes = R"(
Follows every peak of the base's amplitude over a window of eta as the preload varies, and finds the preload at which
the highest peak is lowest, for each design. Writes DIR/study.sqlite (each design as soon as it is done) and at the end
DIR/optimum.csv (one row for each design), DIR/sweep.csv (one row for each peak and preload) and DIR/summary.json. A
study that was interrupted or killed goes on with --resume; without it a study in DIR is begun anew.

In place of a list a range, { from = 1.0, to = 100.0, count = 50, scale = "log" } ("linear" if not given); in place of
the table of lists an array of designs, [{ mass_ratio = 5.0, slenderness = 8.3 }, ...]. Preloads of
continuation.stop_at get a row for every peak. Where something scatters, DIR/quantiles.csv has the quantiles and
DIR/robust.csv the preload at which the 95 % quantile is lowest.

A case file has [system] and [geometry], as for arcslip run, and these keys; problems/figure_12.toml is one:

)";

void add_settings(CLI::App* command, std::vector<std::string>& settings) {
  command->add_option("--set", settings, "Replace a value of the case file; may be repeated")
      ->type_name("section.key=value")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
}

CLI::App* add_run_command(CLI::App& app, arcslip::RunOptions& options) {
  CLI::App* run = app.add_subcommand("run", "Trace the branches that [branch] of a case file asks for");
  run->add_option("CASE", options.case_path, "Case file (TOML)")->required();
  CLI::Option* output =
      run->add_option("-o,--output", options.folder, "Folder for the results; out/<case> if not given")
          ->type_name("DIR");
  run->add_option("--resume", options.resume,
                  "Go on with the interrupted run of this case in DIR, or one that had no time")
      ->type_name("DIR")
      ->excludes(output);
  add_settings(run, options.settings);
  run->add_flag("--quiet", options.quiet, "Print neither progress nor the table");
  run->add_flag(
      "--verify", options.verify,
      "Solve special points and samples of forced responses anew, with more harmonics and by integrating "
      "the whole ring in time; writes DIR/verify.csv");
  run->add_flag(
      "--certify", options.certify,
      "Prove by interval arithmetic that each branch exists as traced, has no other folds and was not "
      "jumped; forced responses with one contact; status 3 where a segment is not proven");
  run->footer([] {
    return run_notes + arcslip::list_keys({"system", "geometry", "element", "branch", "continuation"});
  });
  return run;
}

CLI::App* add_study_command(CLI::App& app, arcslip::StudyOptions& options) {
  CLI::App* study = app.add_subcommand("study", "Find the best preload of each design that [study] asks for");
  study->add_option("CASE", options.case_path, "Case file (TOML)")->required();
  study->add_option("-o,--output", options.folder, "Folder for the results; out/<case> if not given")
      ->type_name("DIR");
  study->add_option("--jobs", options.jobs, "Threads; one for each core if not given")
      ->type_name("N")
      ->check(CLI::Range(1, 4096));
  study->add_flag("--resume", options.resume, "Go on with the study in DIR, if there is one");
  add_settings(study, options.settings);
  study->add_flag("--quiet", options.quiet, "Print neither progress nor the table");
  study->footer([] {
    return study_notes + arcslip::list_keys({"study", "study.uncertain", "continuation"});
  });
  return study;
}

int dispatch(int argc, char** argv) {
  using namespace arcslip;
  CLI::App app{about, "arcslip"};
  app.set_version_flag("--version", std::string("arcslip ") + release);
  app.require_subcommand(1);
  app.footer(examples);

  RunOptions traced;
  const CLI::App* run = add_run_command(app, traced);
  StudyOptions studied;
  const CLI::App* study = add_study_command(app, studied);

  CheckOptions checked;
  CLI::App* check = app.add_subcommand("check", "Read and validate a case file, print what would run");
  check->add_option("CASE", checked.case_path, "Case file (TOML)")->required();
  check->add_flag(
      "--derivatives", checked.derivatives,
      "Compare the problem's exact derivatives with differences on the branch; status 3 if one differs");
  add_settings(check, checked.settings);

  std::string folder;
  CLI::App* plot =
      app.add_subcommand("plot", "Draw what is in a folder of results (PNG and SVG; needs gnuplot)");
  plot->add_option("DIR", folder, "Folder that `arcslip run` or `arcslip study` wrote")->required();

  HelpOptions asked;
  CLI::App* help = app.add_subcommand("help", "List the keys of case files, or tell all of one");
  help->add_option("KEY", asked.key, "As max_step, or continuation.max_step");
  help->add_flag("--markdown", asked.markdown, "All keys as tables in Markdown");

  SectorOptions sectors;
  const CLI::App* sector = add_sector_command(app, sectors);

  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() != 0) {
      complain(std::string("arcslip: ") + error.what() + "; see arcslip --help");
      return status::wrong_command_line;
    }
    std::ostringstream asked_for;  // --help, --version
    app.exit(error, asked_for);
    print(asked_for.str());
    return status::done;
  }
  if (run->parsed()) return run_command(traced);
  if (study->parsed()) return study_command(studied);
  if (check->parsed()) return check_command(checked);
  if (help->parsed()) return help_command(asked);
  if (sector->parsed()) return sector_command(sectors);
  return plot_command(folder);
}

}  // namespace

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
#ifdef SIGXFSZ
  std::signal(SIGXFSZ, SIG_IGN);  // a file over the size limit is reported as one that cannot be written
#endif
  std::signal(SIGPIPE, SIG_IGN);
  return arcslip::guarded([&] { return dispatch(argc, argv); });
}
