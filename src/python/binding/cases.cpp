#include "python/binding/cases.hpp"

#include <fmt/format.h>
#include <pybind11/stl.h>

#include <thread>

#include "arcslip/cases/case_file.hpp"
#include "arcslip/cases/certification.hpp"
#include "arcslip/version.hpp"
#include "cases/case_warnings.hpp"
#include "cases/structure_kind.hpp"
#include "python/binding/own_element.hpp"
#include "python/binding/own_structure.hpp"
#include "python/binding/run.hpp"
#include "results/case_check.hpp"
#include "results/output.hpp"
#include "results/output_folder.hpp"
#include "results/study_results.hpp"
#include "results/study_run.hpp"

namespace arcslip::python {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// A case with what its functions raise.
struct OpenCase {
  CaseFile file;
  std::shared_ptr<Raised> raised;
};

OpenCase open_case(const std::string& name, const std::optional<std::string>& text,
                   const std::vector<std::string>& settings, std::map<std::string, std::string> files,
                   const py::list& elements, const py::dict& structures) {
  auto raised = std::make_shared<Raised>();
  auto parts = std::make_shared<CaseParts>();
  parts->files = std::move(files);
  for (const py::handle element : elements)
    parts->elements.push_back(kind_of(py::reinterpret_borrow<py::object>(element), raised));
  for (const auto& [model, structure] : structures) {
    const auto taken = model.cast<std::string>();
    if (structure_of(taken) != nullptr || problems::find_model(taken) != nullptr)
      throw py::value_error(fmt::format("structure '{}': there is a model of this name", taken));
    parts->structures[taken] = structures_of(py::reinterpret_borrow<py::object>(structure), raised);
  }
  const py::gil_scoped_release unlocked;
  return {text ? CaseFile::of_text(name, *text, settings, parts) : CaseFile(name, settings), raised};
}

/// Work without the lock; what functions raise comes before what becomes of it.
template <class Work>
auto unlocked(const OpenCase& opened, const Work& work) {
  try {
    auto result = [&] {
      const py::gil_scoped_release released;
      return work();
    }();
    opened.raised->rethrow();
    return result;
  } catch (...) {
    opened.raised->rethrow();
    throw;
  }
}

/// Tells what a case is warned of; with the lock, without which it is called. What `warn` raises ends the
/// work.
void tell(const py::object& warn, const std::vector<std::string>& warnings) {
  const py::gil_scoped_acquire lock;
  for (const std::string& one : warnings) warn(one);
}

/// What a study leaves beside its files.
struct StudyOutcome {
  bool interrupted = false;
  std::size_t done = 0;
  std::size_t count = 0;
  std::vector<std::string> failures;
  std::vector<std::string> warnings;
};

struct StudyOptions {
  std::string folder;
  std::size_t jobs = 0;  ///< 0: one for each core
  bool resume = false;
  const py::object* warn = nullptr;
};

/// Without the lock.
StudyOutcome study_case(const CaseFile& file, const StudyOptions& options, Interruption& interruption) {
  const StudyCase study = read_study(file);
  file.named("system", [&] { build(study.design(0).problem()); });
  tell(*options.warn, warnings_of(study));
  const Clock::time_point start = Clock::now();
  const OutputFolder held(options.folder);
  StudyStore store(options.folder, study, options.resume);
  PendingDesigns pending(store.finished());
  const std::size_t before = study.items() - pending.left();
  StudyWork work;
  {
    const std::size_t cores = std::max(1U, std::thread::hardware_concurrency());
    work.threads = options.jobs > 0 ? options.jobs : cores;
    StudyWorkers workers(study, work.threads);
    compute(
        workers, pending,
        [&](const FinishedDesign& design) {
          store.add(design.curve, design.values, design.result, design.scatter());
          ++work.computed;
        },
        [&] {
          store.keep();
          return interruption.go_on([&] { return py::make_tuple(before + work.computed, study.items()); });
        });
  }
  work.seconds = seconds_since(start);
  StudyOutcome outcome{interruption.is_stopped(), before + work.computed, study.items(), {}, {}};
  if (outcome.done < study.items()) {
    store.tidy();
    return outcome;
  }
  work.checks = check_best_preloads(study, store, [&] { return interruption.go_on(); });
  write_results(options.folder, study, store, work);
  store.tidy();
  outcome.interrupted = interruption.is_stopped();
  outcome.warnings = warnings_of(work.checks);
  store.visit(StudyStore::Which::failed, [&](const StoredDesign& design) {
    outcome.failures.push_back(fmt::format("design {}: {}", design.curve, design.failure));
    return true;
  });
  return outcome;
}

StudyOutcome run_study(const OpenCase& opened, const std::string& folder, std::size_t jobs, bool resume,
                       const py::object& progress, const py::object& warn) {
  Interruption interruption(progress, opened.raised);
  StudyOutcome outcome = unlocked(opened, [&] {
    return study_case(opened.file, {folder, jobs, resume, &warn}, interruption);
  });
  interruption.rethrow();
  return outcome;
}

py::tuple check(const OpenCase& opened, bool derivatives) {
  const CaseCheck found = unlocked(opened, [&] { return check_case(opened.file, derivatives); });
  return py::make_tuple(found.text, found.good, found.warnings);
}

std::shared_ptr<CaseRun> run_case(const OpenCase& opened, const std::optional<std::string>& folder,
                                  bool verify, bool certify, const std::string& resumed,
                                  const std::shared_ptr<CaseRun>& before, const py::object& progress,
                                  const py::object& warn) {
  Interruption interruption(progress, opened.raised);
  auto run = unlocked(opened, [&] {
    auto begun = std::make_shared<CaseRun>(opened.file, RunWishes{verify, certify, resumed, before});
    tell(warn, begun->warnings());
    begun->trace(folder, interruption);
    return begun;
  });
  interruption.rethrow();
  return run;
}

}  // namespace

void bind_cases(py::module_& module) {
  module.attr("version") = release;
  py::register_local_exception<InputError>(module, "InputError", PyExc_ValueError);
  py::register_local_exception<OutputError>(module, "OutputError", PyExc_OSError);
  const py::class_<OpenCase> opaque(module, "Case");
  module.def("open_case", open_case);
  module.def("check", check);
  module.def("run", run_case);
  module.def("study", run_study);
  py::class_<StudyOutcome>(module, "StudyOutcome")
      .def_readonly("interrupted", &StudyOutcome::interrupted)
      .def_readonly("done", &StudyOutcome::done)
      .def_readonly("count", &StudyOutcome::count)
      .def_readonly("failures", &StudyOutcome::failures)
      .def_readonly("warnings", &StudyOutcome::warnings);
  py::class_<CaseRun, std::shared_ptr<CaseRun>>(module, "Run")
      .def_property_readonly("branches", &CaseRun::branches)
      .def_property_readonly("failures", &CaseRun::failures)
      .def_property_readonly("taken_over", &CaseRun::taken_over)
      .def("verifications", &CaseRun::verifications)
      .def_property_readonly("interrupted", &CaseRun::interrupted)
      .def_property_readonly("title", &CaseRun::title)
      .def_property_readonly("seconds", &CaseRun::seconds)
      .def("summary", &CaseRun::summary, py::call_guard<py::gil_scoped_release>())
      .def("write", &CaseRun::write, py::call_guard<py::gil_scoped_release>());
}

}  // namespace arcslip::python
