#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <filesystem>
#include <memory>
#include <optional>
#include <utility>

#include "app/command.hpp"
#include "app/commands.hpp"
#include "app/interrupt.hpp"
#include "app/progress.hpp"
#include "app/wrap.hpp"
#include "arcslip/cases/case_file.hpp"
#include "arcslip/cases/certification.hpp"
#include "arcslip/results/results.hpp"
#include "cases/case_warnings.hpp"
#include "keys/printable.hpp"
#include "results/atlas_table.hpp"
#include "results/certificate_results.hpp"
#include "results/output.hpp"
#include "results/output_folder.hpp"
#include "results/run_files.hpp"
#include "results/run_progress.hpp"
#include "results/shapes.hpp"
#include "results/solution_results.hpp"
#include "results/stability_results.hpp"
#include "results/verification_results.hpp"

namespace arcslip {
namespace {

struct RunOptions {
  std::string case_path;
  std::string folder;                 ///< empty: out/<name of the case file>
  std::vector<std::string> settings;  ///< "section.key=value"
  bool quiet = false;
  bool verify = false;   ///< solve points of each branch anew, by other means
  bool certify = false;  ///< prove each branch by interval arithmetic
  bool shapes = false;   ///< write those of special points
  std::string resume;    ///< folder of the interrupted run to go on with; empty: none
};

/// Why it ended, where not at an end of its range.
std::string ends_of(const continuation::Branch& branch) {
  using continuation::Stop;
  std::string text;
  if (branch.first_stop && *branch.first_stop != Stop::reached_end && *branch.first_stop != Stop::left_range)
    text +=
        fmt::format("{}, before the start: {}\n", to_string(*branch.first_stop), branch.first_explanation);
  if (branch.stop != Stop::reached_end || !branch.warning.empty())
    text += fmt::format("{}: {}\n", to_string(branch.stop), branch.explanation);
  return text;
}

/// Refuses what cannot be verified, what no certificate covers, and what has no shapes.
void require_possible(const CaseBranch& branch, const RunOptions& options) {
  std::string why = options.shapes ? why_no_shapes(branch) : "";
  if (!why.empty())
    throw InputError(
        fmt::format("{}: --shapes needs a forced response of sectors and the places of their dofs: {}",
                    options.case_path, why));
  why = options.verify ? why_not_verifiable(branch) : "";
  if (!why.empty())
    throw InputError(fmt::format("{}: --verify is for forced responses, not for {}", options.case_path, why));
  if (options.certify) why = why_not_certifiable(branch);
  if (why.empty()) return;
  throw InputError(fmt::format(
      "{}: --certify is for forced responses of one contact with linear structures, which are one "
      "equation in one unknown, ln R, that intervals enclose in closed form; not for {}",
      options.case_path, why));
}

/// The same before anything runs, of as many branches as are looked at in no time.
void require_possible(const CasePlan& plan, const RunOptions& options) {
  constexpr std::size_t some = 10'000;
  if (!options.verify && !options.certify && !options.shapes) return;
  for (std::size_t i = 0; i < std::min(plan.count, some); ++i) require_possible(plan.branch(i), options);
}

/// One run of the program.
class Run {
 public:
  explicit Run(const RunOptions& options)
      : options_(options),
        file_(options.case_path, options.settings),
        plan_(plan_case(file_)),
        title_(plan_.title.empty() ? "" : printable(plan_.title) + "\n\n") {}

  int execute();

 private:
  void trace_request(std::size_t i, RunFiles& files, const std::string& folder);
  void report(const TracedBranch& traced, std::size_t number);
  std::string described(const TracedBranch& traced, std::size_t number);
  void certify_branch(TracedBranch& traced, RunFiles& files);
  void verify_branch(const TracedBranch& traced, RunFiles& files);
  void show(const std::string& text);
  void say_interrupted() const;

  const RunOptions& options_;
  CaseFile file_;
  CasePlan plan_;
  std::string title_;  ///< still to be printed
  Clock::time_point start_ = Clock::now();
  std::atomic<std::size_t> begun_ = 0;
  std::atomic<std::size_t> ended_ = 0;
  std::size_t points_ = 0;
  bool complete_ = true;
  std::string unprinted_;  ///< why standard output cannot be written
  RunProgress progress_;
};

int Run::execute() {
  require_possible(plan_, options_);
  file_.named("system", [&] {
    build(plan_.branch(0).problem);
    if (options_.shapes) RingShapes(plan_.branch(0).problem.system);
    if (!options_.quiet) warn(warnings_of(plan_));
  });
  const bool resumes = !options_.resume.empty();
  if (resumes) progress_.take_up(options_.resume, plan_);
  const RunCheckpoint reached = progress_.reached();
  const OutputFolder folder(resumes ? options_.resume : results_folder(options_.folder, options_.case_path));
  RunFiles files(folder.path(), plan_, options_.verify);
  files.take_over(reached.branches, reached.header);
  points_ = reached.points;
  complete_ = reached.complete;
  begun_ = ended_ = reached.requests;
  const BeforeTheEnd finish_by_itself({});
  {
    const BeforeTheEnd write_what_there_is([&] {
      files.finish(seconds_since(start_), true);
      progress_.settle(folder.path(), plan_, true);
      say_interrupted();
    });
    try {
      for (std::size_t i = reached.requests; i < plan_.count && !interrupted(); ++i)
        trace_request(i, files, folder.path());
    } catch (const InputError&) {
      files.finish(seconds_since(start_), true);
      throw;
    }
  }
  const bool is_cut_short = interrupted() && !(ended_ == plan_.count && complete_);
  files.finish(seconds_since(start_), is_cut_short);
  progress_.settle(folder.path(), plan_, is_cut_short);
  show(fmt::format("\n{}, {} points, {:.3g} s: {}/branches.csv, summary.json\n",
                   plural(files.count(), "branch", "es"), points_, seconds_since(start_), folder.path()));
  if (ended_ < plan_.count) say_interrupted();
  if (!unprinted_.empty()) throw OutputError(unprinted_);
  return complete_ && ended_ == plan_.count ? status::done : status::incomplete_branch;
}

void Run::trace_request(std::size_t i, RunFiles& files, const std::string& folder) {
  CaseBranch request = plan_.branch(i);
  require_possible(request, options_);
  request.options.journal = &progress_.begin(request, options_.verify || options_.certify,
                                             {i, files.count(), points_, complete_, files.header()});
  request.options.go_on = [] { return !interrupted(); };
  begun_ = i + 1;
  const std::size_t points_before = points_;
  ProgressLine line(!options_.quiet);
  std::size_t points = 0;
  const auto watch = [&](const continuation::BranchPoint& point) {
    ++points;
    line.show([&] {
      const continuation::TraceOptions& options = request.options;
      return fmt::format("branch {} of {}: {} points, {:.0f} s, arclength {:.4g}, {} from {:g} to {:g}",
                         i + 1, plan_.count, points, seconds_since(start_), point.arclength,
                         options.parameter, options.from, options.to);
    });
    return !interrupted();
  };
  std::vector<TracedBranch> traced;
  try {
    file_.named("system", [&] { traced = trace(request, watch); });
  } catch (const InputError& error) {
    files.add_failed(request, error.what());
    complete_ = false;
    complain(fmt::format("{} (branch {}{}{})", error.what(), files.count() - 1,
                         request.values.empty() ? "" : ": ", arcslip::describe(request.values)));
  }
  if (!traced.empty() && traced.front().solutions && !options_.quiet)
    show(describe_solutions(request, *traced.front().solutions));
  std::optional<RingShapes> shapes;
  for (TracedBranch& one : traced) {
    {
      const Undisturbed writing;
      files.add(one);
    }
    report(one, files.count() - 1);
    if (options_.shapes) {
      file_.named("system", [&] {
        if (!shapes) shapes.emplace(request.problem.system);
        write_shapes(folder, shapes->responses(files.count() - 1, one));
      });
    }
    if (options_.certify) certify_branch(one, files);
    if (options_.verify) verify_branch(one, files);
  }
  if (interrupted() && complete_) return;  // traced, but its largest errors may not be known
  ended_ = i + 1;
  if (!interrupted() && std::none_of(traced.begin(), traced.end(), has_more))
    progress_.end(i, points_ - points_before);
}

void Run::report(const TracedBranch& traced, std::size_t number) {
  points_ += traced.surface ? traced.surface->charts.size() : traced.branch.points.size();
  if (!options_.quiet) show(described(traced, number));
  const std::string why = doubt_about(traced.branch);
  if (why.empty()) return;
  complete_ = false;
  complain(fmt::format("arcslip: branch {}: {}", number, why));
}

std::string Run::described(const TracedBranch& traced, std::size_t number) {
  std::string text = std::exchange(title_, "");
  const std::string values = arcslip::describe(traced.request->values);
  if (!values.empty()) text += fmt::format("{}{}\n", number == 0 ? "" : "\n", values);
  const ProblemRequest& problem = traced.request->problem;
  if (problem.geometry) text += describe_groups(problem) + "\n" + describe_units(problem) + "\n";
  text += describe_harmonics(traced);
  text += traced.surface
              ? surface_sentence(surface_to_json(traced)) + "\n"
              : special_table_header(traced) + special_table(number, traced) + describe_stability(traced);
  return text + ends_of(traced.branch);
}

/// Prints what is proven, on stderr what is not.
void Run::certify_branch(TracedBranch& traced, RunFiles& files) {
  certify(traced);
  files.add_certificate(*traced.certificate);
  const std::string text = describe_certificate(files.count() - 1, traced);
  if (traced.certificate->proven()) return show(text);
  complete_ = false;
  complain("arcslip: " + text);
}

void Run::verify_branch(const TracedBranch& traced, RunFiles& files) {
  const std::size_t number = files.count() - 1;
  ProgressLine line(!options_.quiet);
  problems::VerifyOptions options;
  options.progress = [&](std::size_t point, std::size_t points) {
    line.show([&] { return fmt::format("verifying branch {}: point {} of {}", number, point + 1, points); });
    return !interrupted();
  };
  options.found = [&](const problems::Verification& point) { files.add(traced, point); };
  files.begin_verification();
  const VerifiedBranch verified = verify(number, traced, options);
  files.end_verification(verified);
  if (verified.is_complete()) return show(describe_verification(verified));
  complete_ = false;
  complain(fmt::format("arcslip: branch {}: not verified: interrupted after {} of {} points", number,
                       verified.points.size(), verified.chosen));
}

/// What cannot be printed is said at the end: the results are to be written whatever becomes of the table.
void Run::show(const std::string& text) {
  if (options_.quiet || !unprinted_.empty()) return;
  try {
    print(text);
  } catch (const OutputError& error) {
    unprinted_ = error.what();
  }
}

void Run::say_interrupted() const {
  const std::size_t left = plan_.count - begun_;
  std::string what =
      left > 0 ? fmt::format("{} of {} not begun", left, plural(plan_.count, "branch", "es")) : "";
  if (begun_ > ended_) what += fmt::format("{}one not brought to its end", left > 0 ? ", " : "");
  complain("arcslip: interrupted" + (what.empty() ? "" : ": " + what));
}

}  // namespace

std::string results_folder(const std::string& given, const std::string& case_path) {
  if (!given.empty()) return given;
  const std::filesystem::path name = std::filesystem::path(case_path).filename();
  const bool is_place = name.stem() == "." || name.stem() == "..";  // as of "...toml"
  return "out/" + (is_place ? name : name.stem()).string();
}

namespace {

int run(const RunOptions& options) {
  catch_interrupts();
  const BeforeTheEnd say_so([] { complain("arcslip: interrupted"); });
  return Run(options).execute();
}

constexpr const char* run_notes = R"(
Writes DIR/branches.csv (one row for each point), DIR/curves.csv (more rows in between, for pictures), DIR/summary.json
(special points, why each branch ended) and prints the special points. Branches are written as they come. Ctrl-C ends a
run cleanly: what was traced is written and marked as interrupted, with DIR/run.checkpoint, from which --resume DIR goes
on to the same tables; so it does where max_seconds were too few.

A curve of peaks in two parameters: curve = "peak", parameters = ["eta", "P"], window = [0.5, 120.0] of eta, from = 0.1 and
to = 100.0 of P. A case file has these keys, of which `arcslip help KEY` tells more; problems/figure_8.toml is one:

)";

Command::Action add_run(CLI::App& app) {
  const auto options = std::make_shared<RunOptions>();
  CLI::App* command = app.add_subcommand("run", "Trace the branches that [branch] of a case file asks for");
  command->add_option("CASE", options->case_path, "Case file (TOML)")->required();
  CLI::Option* output = add_results_folder(command, options->folder);
  add_folder(command, "--resume", options->resume,
             "Go on with the interrupted run of this case in DIR, or one that had no time")
      ->excludes(output);
  add_settings(command, options->settings);
  command->add_flag("--quiet", options->quiet, "Print neither progress nor the table");
  command->add_flag(
      "--verify", options->verify,
      "Solve special points and samples of forced responses anew, with more harmonics and by integrating "
      "the whole ring in time; writes DIR/verify.csv and DIR/offsets.csv");
  command->add_flag(
      "--certify", options->certify,
      "Prove by interval arithmetic that each branch exists as traced, has no other folds and was not "
      "jumped; forced responses with one contact; status 3 where a segment is not proven");
  command->add_flag("--shapes", options->shapes,
                    "Write the shape of the ring at each special point of forced responses, of sectors whose "
                    "dofs have `coordinates`: DIR/shapes/*.vtu, for ParaView");
  command->footer([] {
    return as_paragraphs(run_notes) +
           list_keys({"system", "model", "geometry", "element", "excitation", "branch", "continuation"});
  });
  return [options] { return run(*options); };
}

}  // namespace

Command run_command() { return {"run", add_run}; }

}  // namespace arcslip
