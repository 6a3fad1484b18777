#include <CLI/CLI.hpp>
#include <csignal>
#include <new>
#include <sstream>

#include "app/command_sector.hpp"
#include "app/commands.hpp"
#include "app/interrupt.hpp"
#include "arcslip/cases/case_file.hpp"
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
  arcslip study problems/chart.toml               the best preload of each of 400 designs
  arcslip sector plate -o rotor                   finite-element matrices of a brake rotor and its ring

Exit status
  0 done; 1 wrong input; 2 wrong command line; 3 a branch was not traced, or a study not made, to its end, or a branch not certified,
  or an interrupt; 4 a file or standard output could not be written)";

constexpr const char* run_notes = R"(
Writes DIR/branches.csv (one row for each point), DIR/curves.csv (more rows in between, for pictures), DIR/summary.json
(special points, why each branch ended) and prints the special points. Branches are written as they come. Ctrl-C ends a run cleanly: what was traced is written and marked
as interrupted.

A case file; what follows "optional" need not be given:
  title = "Two beams"
  [system]
  model = "beams"            # or "rods"; or a model of the library with its parameters:
                             # ab bratu bratu_2d cusp duffing enz freudenstein_roth lorenz84 lure pp2
  wave_number = 1            # n
  elements = 30              # N > 2n
  mass_ratio = 5.0           # M*
  frequency_ratio = 4.0      # gamma
  slenderness = 33.3         # L/h_D, beams; or interface_stiffness = K_FD
  force = 1.0                # F
  preload = 1.0              # P
  # optional
  poisson_ratio = 0.3
  damping = { base = 1e-4, damper = 1e-4, kind = "viscous" }   # base may be < 0; kind: or "structural"
  preload_growth = 0.0       # P_2 of the preload P + P_2 eta^2
  cubic_stiffness = 0.0      # of springs between base and ground
  fixed_damper = false       # true: friction against a rigid ring
  harmonics = 1              # highest odd harmonic of the friction force, a list [1, 3, 9], or "auto"
  harmonics_tolerance = 1e-4 # with "auto": the largest harmonic left out, relative to R
  [geometry]                 # in place of mass_ratio to preload, and of poisson_ratio: two rings in SI units
  circumference = 0.8        # or radius, the mean one
  friction_coefficient = 0.3
  preload_per_length = 300   # p_0, N/m
  force_per_length = 100     # f_0, N/m
  base = { elastic_modulus = 110e9, density = 7200, width = 0.045, height = 0.024 }
  damper = { elastic_modulus = 210e9, density = 7850, poisson_ratio = 0.29, width = 0.006, height = 0.004 }
  [branch]
  parameter = "eta"          # or "P", with eta = ... for the fixed frequency; or a library model's parameter
  from = 0.5
  to = 120.0
  # optional
  response = "forced"        # "one_way": of a damper on a base that moves as if alone
                             # "limit_cycle": vibration without force, parameter = "zeta_B" or "P"
                             # "nonlinear_mode": frequency and damping over the amplitude, parameter = "R",
                             # of the mode near eta = ...
  start = 3.0                # trace both ways from here
  all_solutions = false      # true: trace through every solution at start that deflation finds
  switching = false          # true: follow all branches that meet this one; not beside start
  stability = false          # true: growth of disturbances of a forced response, in every wave
  extrema_of = ["Y"]         # observables whose peaks and troughs are located
  for_each = { preload = [0.1, 1.0, 10.0] }   # one branch for each; several lists are walked together
  [continuation]             # all optional
  tolerance = 1e-10
  max_step = 0.1
  min_step = 1e-10
  max_points = 100000
  max_seconds = 60           # of a branch with all its parts, from the search for its first point on
  stop_at = [3.9, 4.1]       # values to land on exactly
  stop_after = "fold"        # or { fold = 2, peak = 5 }: the branch ends there

A curve of special points in two parameters, in place of parameter, from and to:
  [branch]
  curve = "peak"             # "trough", "switch", "fold", "branch_point", "hopf"
  parameters = ["eta", "P"]  # first points on a branch over eta at [system]'s P, then both move
  window = [0.5, 120.0]      # of eta, searched from its first value to its second
  from = 0.1                 # of P
  to = 100.0)";

constexpr const char* study_notes = R"(
Follows every peak of the base's amplitude over a window of eta as the preload varies, and finds the preload at which
the highest peak is lowest, for each design. Writes DIR/study.sqlite (each design as soon as it is done) and at the end
DIR/optimum.csv (one row for each design), DIR/sweep.csv (one row for each peak and preload) and DIR/summary.json. A
study that was interrupted or killed goes on with --resume; without it a study in DIR is begun anew.

A case file has [system] and [geometry], as for arcslip run but for the preload, which is not needed, and:
  [study]
  parameter = "P"
  from = 0.1                 # preloads
  to = 100.0
  eta = [0.5, 6.0]           # the window in which peaks are sought
  # optional
  for_each = { mass_ratio = [5.0, 10.0], frequency_ratio = [2.0, 4.0] }   # every value with every other
  sweep = true               # false: no sweep.csv, for charts of very many designs
  [study.uncertain]          # optional: factors that scatter about the nominal values
  mu = { lognormal = 0.2 }              # standard deviation of the logarithm
  preload = { uniform = [0.8, 1.25] }   # or force; one of the three at least
  samples = 4000             # optional, as what follows
  seed = 1
  quantiles = [0.05, 0.5, 0.95]         # of the highest peak, at every preload

In place of a list a range, { from = 1.0, to = 100.0, count = 50, scale = "log" } ("linear" if not given); in place of
the table of lists an array of designs, [{ mass_ratio = 5.0, slenderness = 8.3 }, ...]. Preloads of
continuation.stop_at get a row for every peak. Where something scatters, DIR/quantiles.csv has the quantiles and
DIR/robust.csv the preload at which the 95 % quantile is lowest.)";

void add_settings(CLI::App* command, std::vector<std::string>& settings) {
  command->add_option("--set", settings, "Replace a value of the case file; may be repeated")
      ->type_name("section.key=value")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
}

CLI::App* add_run_command(CLI::App& app, arcslip::RunOptions& options) {
  CLI::App* run = app.add_subcommand("run", "Trace the branches that [branch] of a case file asks for");
  run->add_option("CASE", options.case_path, "Case file (TOML)")->required();
  run->add_option("-o,--output", options.folder, "Folder for the results; out/<case> if not given")
      ->type_name("DIR");
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
  run->footer(run_notes);
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
  study->footer(study_notes);
  return study;
}

int dispatch(int argc, char** argv) {
  using namespace arcslip;
  CLI::App app{about, "arcslip"};
  app.set_version_flag("--version", "arcslip " ARCSLIP_VERSION);
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
