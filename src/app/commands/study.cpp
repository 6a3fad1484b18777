#include <fmt/format.h>

#include <chrono>
#include <memory>
#include <optional>

#include "app/command.hpp"
#include "app/commands.hpp"
#include "app/crew.hpp"
#include "app/interrupt.hpp"
#include "app/progress.hpp"
#include "app/wrap.hpp"
#include "arcslip/cases/runs.hpp"
#include "cases/case_warnings.hpp"
#include "keys/printable.hpp"
#include "results/answer.hpp"
#include "results/output.hpp"
#include "results/output_folder.hpp"
#include "results/study_results.hpp"

namespace arcslip {
namespace {

struct StudyOptions {
  std::string case_path;
  std::string folder;                 ///< empty: out/<name of the case file>
  std::size_t jobs = 0;               ///< threads; 0: one for each core
  bool resume = false;                ///< go on with the study in the folder
  std::vector<std::string> settings;  ///< "section.key=value"
  bool quiet = false;
};

/// How far the study is: designs done before and now, of how many.
std::string progress(std::size_t before, const StudyWork& work, std::size_t count) {
  const std::size_t done = before + work.computed;
  std::string text = fmt::format("{} of {} designs", done, count);
  if (work.computed == 0) return text;
  return text + fmt::format(", {:.3g} a second, {} left", work.rate(),
                            in_words(static_cast<double>(count - done) / work.rate()));
}

std::string designs_in_words(const StudyCase& study) {
  const std::string designs = plural(study.count, "design");
  return study.patterns > 0 ? fmt::format("{} of {} patterns", designs, study.patterns) : designs;
}

/// The tables beside optimum.csv.
std::string list_of_files(const StudyCase& study) {
  std::string files;
  if (study.sweep) files += "sweep.csv, ";
  if (study.uncertain) files += study.sweep ? "robust.csv, quantiles.csv, " : "robust.csv, ";
  if (study.patterns > 0) files += "patterns.csv, ";
  return files;
}

/// Names each design that failed, with the reason. Returns how many there are.
std::size_t report_failures(const StudyCase& study, const StudyStore& store) {
  std::size_t failures = 0;
  store.visit(StudyStore::Which::failed, [&](const StoredDesign& design) {
    ++failures;
    const std::string values = arcslip::describe(study.design(design.item).values);
    complain(fmt::format("arcslip: design {}{}: {}", design.curve, values.empty() ? "" : " (" + values + ")",
                         design.failure));
    return true;
  });
  return failures;
}

/// What was found, in words.
std::string answer(const std::string& folder, const StudyCase& study) {
  std::string text;
  for (const std::string& sentence : study_answer(folder, study.resolved)) text += sentence + "\n";
  return text;
}

/// What a study that is done gives: files, the table, the designs that failed.
int conclude(const StudyOptions& options, const StudyCase& study, const std::string& folder,
             StudyStore& store, StudyWork& work) {
  work.checks = check_best_preloads(study, store, [] { return !interrupted(); });
  write_results(folder, study, store, work);
  store.tidy();
  if (!options.quiet) {
    const std::size_t before = study.items() - work.computed;
    print((study.title.empty() ? "" : printable(study.title) + "\n\n") + study_table(study, store, work) +
          fmt::format("\n{}, {:.3g} s, {:.3g} a second{}: {}/optimum.csv, {}summary.json\n",
                      designs_in_words(study), work.seconds, work.rate(),
                      before > 0 ? fmt::format(" ({} were done before)", before) : "", folder,
                      list_of_files(study)) +
          answer(folder, study));
  }
  warn(warnings_of(work.checks));
  return report_failures(study, store) > 0 ? status::incomplete_branch : status::done;
}

int lead(const StudyOptions& options, const StudyCase& study, std::size_t jobs, Crew& crew) {
  const Clock::time_point start = Clock::now();
  const std::string folder = results_folder(options.folder, options.case_path);
  const OutputFolder held(folder);
  StudyStore store(folder, study, options.resume);
  PendingDesigns pending(store.finished());
  const std::size_t before = study.items() - pending.left();
  StudyWork work{.threads = crew.threads(jobs)};
  bool is_planned = options.quiet;
  const auto say_how_far = [&] {
    complain(fmt::format("arcslip: interrupted: {} of {} designs are done; go on with --resume -o {}",
                         before + work.computed, study.items(), folder));
  };
  const BeforeTheEnd finish_by_itself({});
  {
    const BeforeTheEnd leave_what_there_is([&] {
      store.tidy();
      say_how_far();
    });
    ProgressLine line(!options.quiet);
    crew.compute(
        study, jobs, pending,
        [&](const FinishedDesign& design) {
          const Undisturbed storing;
          store.add(design.curve, design.values, design.result, design.scatter());
          ++work.computed;
        },
        [&] {
          {
            const Undisturbed storing;
            store.keep();
          }
          work.seconds = seconds_since(start);
          line.show([&] { return progress(before, work, study.items()); });
          if (const std::string plan = is_planned ? "" : plan_of(study.items() - before, work);
              !plan.empty()) {
            line.say("arcslip: " + plan);
            is_planned = true;
          }
          return !interrupted();
        });
  }
  work.seconds = seconds_since(start);
  if (before + work.computed == study.items()) return conclude(options, study, folder, store, work);
  say_how_far();
  return status::incomplete_branch;
}

}  // namespace

namespace {

int study(const StudyOptions& options) {
  Crew crew;
  catch_interrupts();
  const BeforeTheEnd say_so([leads = crew.leads()] {
    if (leads) complain("arcslip: interrupted");
  });
  std::optional<StudyCase> study;
  std::string error;
  try {
    const CaseFile file(options.case_path, options.settings);
    study = read_study(file);
    file.named("system", [&] {
      build(study->design(0).problem());
      if (crew.leads() && !options.quiet) warn(warnings_of(*study));
    });
  } catch (const std::exception& wrong) {
    error = wrong.what();
  }
  if (!crew.agree(error)) return status::wrong_input;
  const std::size_t jobs = options.jobs > 0 ? options.jobs : crew.default_jobs();
  if (!crew.leads()) {
    const BeforeTheEnd wait_for_the_leader({});
    return crew.assist(*study, jobs);
  }
  // What went wrong is said before the others leave: their end may end this process as well.
  const int status = guarded([&] { return lead(options, *study, jobs, crew); });
  crew.dismiss(status);
  return status;
}

constexpr const char* study_notes = R"(
Follows every peak of the base's amplitude over a window of eta as the preload varies, and finds the preload at which
the highest peak is lowest, for each design. Writes DIR/study.sqlite (designs as they are done) and at the end
DIR/optimum.csv (one row for each design), DIR/sweep.csv (one row for each peak and preload) and DIR/summary.json. A
study that was interrupted or killed goes on with --resume; without it a study in DIR is begun anew.

In place of a list a range, { from = 1.0, to = 100.0, count = 50, scale = "log" } ("linear" if not given); in place of
the table of lists an array of designs, [{ mass_ratio = 5.0, slenderness = 8.3 }, ...]. Preloads of
continuation.stop_at get a row for every peak. Where something scatters, DIR/quantiles.csv has the quantiles and
DIR/robust.csv the preload at which the 95 % quantile is lowest; of patterns of a whole ring DIR/patterns.csv has each.

A case file has [system] and more as for arcslip run, and these keys; problems/figure_12.toml is one:

)";

Command::Action add_study(CLI::App& app) {
  const auto options = std::make_shared<StudyOptions>();
  CLI::App* command =
      app.add_subcommand("study", "Find the best preload of each design that [study] asks for");
  command->add_option("CASE", options->case_path, "Case file (TOML)")->required();
  add_results_folder(command, options->folder);
  command->add_option("--jobs", options->jobs, "Threads; one for each core if not given")
      ->type_name("N")
      ->check(CLI::Range(1, 4096));
  command->add_flag("--resume", options->resume, "Go on with the study in DIR, if there is one");
  add_settings(command, options->settings);
  command->add_flag("--quiet", options->quiet, "Print neither progress nor the table");
  command->footer([] {
    return as_paragraphs(study_notes) + list_keys({"study", "study.uncertain", "continuation", "system",
                                                   "geometry", "element", "excitation"});
  });
  return [options] { return study(*options); };
}

}  // namespace

Command study_command() { return {"study", add_study}; }

}  // namespace arcslip
