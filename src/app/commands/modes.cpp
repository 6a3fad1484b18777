#include <fmt/format.h>

#include <memory>

#include "app/command.hpp"
#include "app/commands.hpp"
#include "app/interrupt.hpp"
#include "app/wrap.hpp"
#include "arcslip/cases/study_case.hpp"
#include "arcslip/version.hpp"
#include "cases/ring_section.hpp"
#include "keys/printable.hpp"
#include "results/atomic_file.hpp"
#include "results/campbell.hpp"
#include "results/mode_table.hpp"
#include "results/output.hpp"
#include "results/output_folder.hpp"
#include "results/shapes.hpp"
#include "results/wave_damping.hpp"

namespace arcslip {
namespace {

struct ModesOptions {
  std::string case_path;
  std::string folder;                 ///< empty: out/<name of the case file>
  std::vector<std::string> settings;  ///< "section.key=value"
  Index highest = 50;                 ///< number of waves
  double speed = 0;                   ///< revolutions a minute, of engine-order lines; 0: none
  std::vector<double> amplitudes;     ///< R, at which damping is wanted
  std::vector<double> campbell;       ///< two speeds, low and high; empty: none
  bool quiet = false;
  bool shapes = false;  ///< write those of the system's own wave
};

/// The first system that the case is about.
ProblemRequest first_problem(const CaseFile& file) {
  ProblemRequest problem =
      file.has("branch") ? plan_case(file).branch(0).problem : read_study(file).design(0).problem();
  if (problem.model != nullptr)
    throw InputError(fmt::format("{}: modes are those of systems with friction, not of {}", file.path(),
                                 problem.model->name));
  return of_one_sector(std::move(problem));
}

using WrittenFiles = std::vector<std::pair<std::string, std::string>>;

/// The Campbell diagram that is asked for, if one is.
WrittenFiles campbell_files(const CaseFile& file, const ProblemRequest& problem,
                            const ModesOptions& options) {
  WrittenFiles files;
  if (options.campbell.empty()) return files;
  const CampbellRange range{options.campbell[0], options.campbell[1]};
  if (!(range.low >= 0 && range.low < range.high))
    throw InputError(file.path() + ": --campbell needs two speeds, 0 <= low < high");
  file.named("system", [&] {
    check_campbell(problem.system);
    files = {{"campbell.csv", campbell_csv(problem, range)},
             {"crossings.csv", crossings_csv(problem, range)}};
  });
  return files;
}

int modes(const ModesOptions& options) {
  catch_interrupts();
  const BeforeTheEnd say_so([] { complain("arcslip: interrupted"); });
  const CaseFile file(options.case_path, options.settings);
  const ProblemRequest problem = first_problem(file);
  if (options.speed > 0 && !problem.physical)
    throw InputError(file.path() +
                     ": --speed is in revolutions a minute: for systems in SI units, by [geometry] or "
                     "units = \"SI\"");
  if (const std::string why = options.shapes ? why_no_shapes(problem.system) : ""; !why.empty())
    throw InputError(fmt::format("{}: --shapes needs places of the dofs: {}", file.path(), why));
  std::vector<WaveModes> waves;
  std::vector<ShapeFile> shapes;
  if (options.shapes) file.named("system", [&] { shapes = RingShapes(problem.system).modes(); });
  file.named("system", [&] { waves = modes_of(problem, options.highest); });
  std::vector<DampedWave> damped;
  if (!options.amplitudes.empty() && feels_rotation(problem.system))
    throw InputError(file.path() + ": --amplitude is not of sectors that turn");
  if (!options.amplitudes.empty())
    file.named("system", [&] { damped = damping_of_waves(problem, options.highest, options.amplitudes); });
  WrittenFiles files = campbell_files(file, problem, options);
  const OutputFolder folder(results_folder(options.folder, options.case_path));
  const nlohmann::ordered_json about = {
      {"arcslip", release},
      {"nodes", problem.system.elements},
      {"speed_per_minute",
       options.speed > 0 ? nlohmann::ordered_json(options.speed) : nlohmann::ordered_json()}};
  if (!damped.empty()) files.emplace_back("damping.csv", damping_csv(problem, damped));
  files.insert(files.end(), {{"modes.csv", modes_csv(problem, waves)}, {"modes.json", about.dump(2) + "\n"}});
  for (const auto& [name, text] : files) {
    AtomicFile written(folder.path() + "/" + name);
    written.write(text);
    written.sync();
    written.commit();
  }
  if (options.shapes) write_shapes(folder.path(), shapes);
  if (options.quiet) return status::done;
  std::string names = folder.path() + "/modes.csv";
  for (const auto& [name, text] : files) {
    if (name != "modes.csv" && name.ends_with(".csv")) names += fmt::format(", {}/{}", folder.path(), name);
  }
  if (options.shapes) names += fmt::format(", {} shapes in {}/shapes", shapes.size(), folder.path());
  print(modes_text(problem, waves) + (damped.empty() ? "" : damping_text(damped, options.amplitudes)) + "\n" +
        names + "\n");
  return status::done;
}

constexpr const char* modes_notes =
    "\nOf the first branch or design of the case. Writes DIR/modes.csv; arcslip plot DIR draws frequencies "
    "over "
    "nodal diameters, with engine orders where --speed is given. Of sectors modes are those below the end of "
    "the window that the case looks at, or of system.reduction_window.";

Command::Action add_modes(CLI::App& app) {
  const auto options = std::make_shared<ModesOptions>();
  CLI::App* command = app.add_subcommand(
      "modes", "Natural frequencies of base, damper and both stuck, for every nodal diameter");
  command->add_option("CASE", options->case_path, "Case file (TOML)")->required();
  add_results_folder(command, options->folder);
  command->add_option("--to", options->highest, "The highest number of waves; 50 if not given")
      ->type_name("N")
      ->check(CLI::Range(Index{0}, Index{100000}));
  command
      ->add_option("--speed", options->speed, "Revolutions a minute, for engine-order lines in the picture")
      ->type_name("RPM")
      ->check(positive_number());
  command
      ->add_option("--amplitude", options->amplitudes,
                   "An amplitude R of the first contact; may be repeated. Writes DIR/damping.csv, what each "
                   "stuck mode loses at it to structure, flow and friction")
      ->type_name("R")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
      ->allow_extra_args(false)
      ->check(positive_number());
  command
      ->add_option(
          "--campbell", options->campbell,
          "Two speeds, in revolutions in the unit of time of eta: of sectors that turn write the "
          "frequencies of the case's wave, both ways, over these speeds, and where engine orders meet "
          "them: DIR/campbell.csv, DIR/crossings.csv")
      ->type_name("LOW HIGH")
      ->expected(2);
  add_settings(command, options->settings);
  command->add_flag("--shapes", options->shapes,
                    "Write the shapes of the modes with the wave number of the case, of sectors whose dofs "
                    "have `coordinates`: DIR/shapes/*.vtu, for ParaView");
  command->add_flag("--quiet", options->quiet, "Print no table");
  command->footer(as_paragraphs(modes_notes));
  return [options] { return modes(*options); };
}

}  // namespace

Command modes_command() { return {"modes", add_modes}; }

}  // namespace arcslip
