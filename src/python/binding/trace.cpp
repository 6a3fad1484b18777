#include "python/binding/trace.hpp"

#include <fmt/format.h>
#include <pybind11/stl.h>

#include <sstream>

#include "arcslip/continuation/curves/orbit_curve.hpp"
#include "arcslip/continuation/cycles/cycle_branch.hpp"
#include "arcslip/continuation/path/all_solutions.hpp"
#include "arcslip/continuation/path/switching.hpp"
#include "cases/cycles.hpp"
#include "cases/further_curves.hpp"
#include "python/binding/formulas.hpp"
#include "python/binding/trace_options.hpp"
#include "python/binding/tracing.hpp"

namespace arcslip::python {
namespace {

using continuation::Branch;
using continuation::BranchPoint;
using continuation::Guess;
using continuation::PointType;
using continuation::TraceOptions;

/// A further branch of the same model: of `base`, or of a curve over it.
TracedBranch beside(const BranchHandle& handle, const TraceOptions& options, Branch branch, double seconds,
                    std::shared_ptr<const continuation::Problem> base,
                    std::shared_ptr<const continuation::ExtendedProblem> curve = nullptr) {
  TracedBranch traced = handle.traced();
  auto request = std::make_shared<CaseBranch>(*traced.request);
  request->options = options;
  request->options.go_on = {};
  request->curve.reset();
  traced.request = request;
  traced.branch = std::move(branch);
  traced.seconds = seconds;
  traced.certificate.reset();
  traced.told.reset();
  traced.base.problem = std::move(base);
  traced.curve = std::move(curve);
  return traced;
}

continuation::CurveWindow window_of(const std::optional<std::pair<double, double>>& given) {
  return given ? continuation::CurveWindow{given->first, given->second} : continuation::CurveWindow{};
}

/// What a given derivative is that is not that of its function.
void require_exact(const continuation::Problem& problem, const Guess& guess, const TraceOptions& options) {
  Interruption interruption;
  const PythonProblem::Listener listener(interruption);
  const Index parameter = continuation::index_of(problem.parameter_names(), options.parameter);
  const auto wrong = problem.wrong_derivative(guess.unknowns, guess.parameters, guess.regime, parameter, {});
  interruption.rethrow();
  if (wrong) throw py::value_error(*wrong);
}

std::vector<Branch> traced_by(const std::string& how, const continuation::Problem& problem,
                              const Guess& guess, const std::pair<Vector, Vector>& box,
                              const TraceOptions& options, const continuation::Observer& observer) {
  if (how == "connected") return continuation::trace_connected(problem, guess, options, observer);
  if (how == "connected both")
    return continuation::trace_connected_through(problem, {guess}, options, observer);
  if (how == "both") return {continuation::trace_both(problem, guess, options, observer)};
  if (how == "one") return {continuation::trace(problem, guess, options, observer)};
  continuation::SolveAllOptions seeking;
  seeking.lower = box.first;
  seeking.upper = box.second;
  seeking.go_on = options.go_on;
  const std::vector<Guess> all = continuation::solve_all(problem, {guess}, seeking);
  return how == "all" ? continuation::trace_connected_through(problem, all, options, observer)
                      : continuation::trace_through(problem, all, options, observer);
}

Handles trace(const std::shared_ptr<PythonProblem>& problem, const py::handle& u, const py::handle& p,
              const py::handle& regime, const std::string& how, const std::pair<Vector, Vector>& box,
              bool check, const py::dict& given, const py::object& progress) {
  TraceOptions options;
  set_options(given, problem, options);
  const Guess guess = guess_of(*problem, u, p, regime);
  const std::shared_ptr<const continuation::Problem> traced = traced_problem(problem);
  if (check) require_exact(*traced, guess, options);
  const Stopwatch watch;
  const std::vector<Branch> branches = in_engine(options, progress, [&](const auto& observer) {
    return traced_by(how, *traced, guess, box, options, observer);
  });
  const double seconds = watch.seconds() / static_cast<double>(branches.size());
  Handles handles;
  for (const Branch& branch : branches) {
    TracedBranch one = traced_of(problem, options, branch);
    one.seconds = seconds;
    handles.push_back(std::make_shared<BranchHandle>(std::move(one), problem));
  }
  return handles;
}

/// The options of a branch with those that are given.
TraceOptions options_of(const BranchHandle& handle, const py::dict& given) {
  TraceOptions options = handle.traced().request->options;
  set_options(given, handle.problem(), options);
  return options;
}

void require_branch(const BranchHandle& handle, const char* what) {
  if (handle.curve()) throw py::value_error(fmt::format("{}: not from a curve in two parameters", what));
}

Handles trace_guesses(const BranchHandle& handle, const std::shared_ptr<const continuation::Problem>& problem,
                      const std::vector<Guess>& guesses, TraceOptions& options, const py::object& progress) {
  Handles handles;
  for (const Guess& guess : guesses) {
    const Stopwatch watch;
    Branch branch = in_engine(options, progress, [&](const auto& observer) {
      return continuation::trace(*problem, guess, options, observer);
    });
    handles.push_back(std::make_shared<BranchHandle>(
        beside(handle, options, std::move(branch), watch.seconds(), problem), handle.problem()));
  }
  return handles;
}

/// Branches of orbits from these, on meshes that follow them.
Handles trace_starts(const BranchHandle& handle, const std::vector<continuation::OrbitStart>& starts,
                     TraceOptions& options, const py::object& progress) {
  Handles handles;
  for (const continuation::OrbitStart& start : starts) {
    const Stopwatch watch;
    continuation::OrbitBranch one = in_engine(options, progress, [&](const auto& observer) {
      return trace_orbits(start, options, handle.traced().request->cycles.options, observer);
    });
    handles.push_back(std::make_shared<BranchHandle>(
        beside(handle, options, std::move(one.branch), watch.seconds(), std::move(one.problem)),
        handle.problem()));
  }
  return handles;
}

/// What a branch is one of, made ready for another parameter that is continued.
std::shared_ptr<const continuation::Problem> base_over(const BranchHandle& handle,
                                                       const TraceOptions& options) {
  if (const auto& problem = handle.problem()) {
    problem->activate(options.parameter);
    problem->scale_within(options.parameter, options.from, options.to);
  }
  const std::shared_ptr<const continuation::Problem>& base = handle.traced().base.problem;
  const auto* formulas = dynamic_cast<const problems::FormulaProblem*>(base.get());
  if (formulas == nullptr) return base;
  problems::FormulaSystem system = formulas->system();
  scale_within(system, options.parameter, options.from, options.to);
  return std::make_shared<const problems::FormulaProblem>(system);
}

Handles start_from(const BranchHandle& handle, std::size_t point, bool forward, const py::dict& given,
                   const py::object& progress) {
  require_branch(handle, "start_from");
  TraceOptions options = options_of(handle, given);
  Guess guess = continuation::restart(handle.point(point), forward);
  std::shared_ptr<const continuation::Problem> base = handle.traced().base.problem;
  if (options.parameter != handle.traced().request->options.parameter) {
    guess.direction.resize(0);  // the tangent is that of another parameter
    const Index parameter = continuation::index_of(base->parameter_names(), options.parameter);
    base = base_over(handle, options);
    options.from = guess.parameters(parameter);
  }
  if (const continuation::OrbitProblem* orbits = orbits_of(handle.traced())) {
    const auto own = about(*orbits, guess.unknowns, guess.parameters, guess.regime);
    guess.regime = {};
    return trace_starts(handle, {{own, guess}}, options, progress);
  }
  return trace_guesses(handle, base, {guess}, options, progress);
}

/// Of a branch of orbits, or of equilibria at a Hopf point.
std::vector<continuation::OrbitStart> orbits_leaving(const BranchHandle& handle, std::size_t row,
                                                     const TraceOptions& options) {
  const continuation::BranchPoint& point = handle.point(row);
  const std::shared_ptr<const continuation::Problem>& base = handle.traced().base.problem;
  std::vector<continuation::OrbitStart> starts;
  if (const auto* cycles = cycles_of(handle.traced());
      cycles != nullptr && point.type == PointType::period_doubling) {
    const Index parameter = continuation::index_of(base->parameter_names(), options.parameter);
    if (auto start = orbit_from_doubling(*cycles, parameter, point)) starts.push_back(std::move(*start));
  } else if (const auto* orbits = orbits_of(handle.traced())) {
    if (auto start = orbit_from_branch_point(*orbits, options.parameter, point, options.tolerances))
      starts.push_back(std::move(*start));
  } else if (point.type == PointType::hopf && may_leave_cycles(*base)) {
    for (const continuation::CycleStart& start : cycles_from_hopf(
             std::make_shared<continuation::EquilibriumField>(base),
             {point.unknowns, point.parameters, point.regime, {}}, handle.traced().request->cycles.options))
      starts.push_back({start.problem, start.guess, start.both_ways});
  }
  return starts;
}

/// The orbits of twice the period that leave a period doubling of a map, which are a branch point of twice as
/// many steps: the second way has the same orbits, one step on.
Handles switch_to_doubled(const BranchHandle& handle, const problems::FormulaProblem& map, BranchPoint point,
                          TraceOptions& options, const py::object& progress) {
  const auto twice = std::make_shared<const problems::FormulaProblem>(map.twice());
  point.type = PointType::branch_point;
  std::vector<Guess> ways;
  for (Guess& way : continuation::other_ways(*twice, options.parameter, point)) {
    const bool is_known = std::any_of(ways.begin(), ways.end(),
                                      [&](const Guess& known) { return known.direction == -way.direction; });
    if (!is_known) ways.push_back(std::move(way));
  }
  return trace_guesses(handle, twice, ways, options, progress);
}

/// The curves that meet one in two parameters, or begin there.
Handles switch_curves(const BranchHandle& handle, std::size_t point,
                      const std::optional<std::pair<double, double>>& window, TraceOptions& options,
                      const py::object& progress) {
  const std::vector<FurtherCurve> further =
      handle.heard([&] { return further_curves(handle.traced(), handle.point(point), window_of(window)); });
  Handles handles;
  for (const FurtherCurve& one : further) {
    const Stopwatch watch;
    TracedBranch found =
        in_engine(options, progress, [&](const auto& observer) { return one.trace(options, observer); });
    handles.push_back(std::make_shared<BranchHandle>(
        beside(handle, options, std::move(found.branch), watch.seconds(), found.base.problem, found.curve),
        handle.problem()));
  }
  return handles;
}

Handles switch_at(const BranchHandle& handle, std::size_t point,
                  const std::optional<std::pair<double, double>>& window, const py::dict& given,
                  const py::object& progress) {
  TraceOptions options = options_of(handle, given);
  if (handle.curve()) return switch_curves(handle, point, window, options, progress);
  const std::vector<continuation::OrbitStart> orbits =
      handle.heard([&] { return orbits_leaving(handle, point, options); });
  if (!orbits.empty() || orbits_of(handle.traced()) != nullptr)
    return trace_starts(handle, orbits, options, progress);
  const std::shared_ptr<const continuation::Problem>& base = handle.traced().base.problem;
  if (const auto* map = dynamic_cast<const problems::FormulaProblem*>(base.get());
      map != nullptr && map->is_map() && handle.point(point).type == PointType::period_doubling)
    return switch_to_doubled(handle, *map, handle.point(point), options, progress);
  const std::vector<Guess> ways =
      handle.heard([&] { return continuation::other_ways(*base, options.parameter, handle.point(point)); });
  return trace_guesses(handle, base, ways, options, progress);
}

std::shared_ptr<BranchHandle> curve_through(const BranchHandle& handle, std::size_t point,
                                            const std::string& observable,
                                            const std::optional<std::pair<double, double>>& window,
                                            const py::dict& given, const py::object& progress) {
  require_branch(handle, "curve");
  const std::string active = handle.traced().request->options.parameter;
  TraceOptions options = options_of(handle, {});
  options.extrema_of.clear();
  options.events.clear();
  options.stop_after.clear();
  options.stop_at.clear();
  set_options(given, handle.problem(), options);
  if (options.parameter == active)
    throw py::value_error("parameter: it is that of the branch; expected another");
  continuation::index_of(handle.traced().base.problem->parameter_names(), options.parameter);
  const std::shared_ptr<const continuation::Problem> base = base_over(handle, options);
  if (options.extrema_of.empty()) options.extrema_of = {observable.empty() ? active : observable};
  const Stopwatch watch;
  continuation::Curve curve = in_engine(options, progress, [&](const auto& observer) {
    return continuation::trace_curve_through(base, active, handle.point(point), observable, options,
                                             window_of(window), handle.traced().request->cycles.options,
                                             observer);
  });
  return std::make_shared<BranchHandle>(beside(handle, options, std::move(curve.branch), watch.seconds(),
                                               std::move(curve.base), std::move(curve.problem)),
                                        handle.problem());
}

/// A branch with the points that follow it; those with negative arclength lie before it.
Branch joined(const Branch& before, Branch after) {
  Branch whole = before;
  const auto is_before = [](const BranchPoint& point) { return point.arclength < 0; };
  const auto middle = std::find_if_not(after.points.begin(), after.points.end(), is_before);
  whole.points.insert(whole.points.begin(), after.points.begin(), middle);
  whole.points.insert(whole.points.end(), middle, after.points.end());
  whole.stop = after.stop;
  whole.explanation = after.explanation;
  if (after.first_stop) {
    whole.first_stop = after.first_stop;
    whole.first_explanation = after.first_explanation;
  }
  whole.work = before.work + after.work;
  whole.checkpoint = std::move(after.checkpoint);
  return whole;
}

std::shared_ptr<BranchHandle> resume(const BranchHandle& handle, const py::dict& given,
                                     const py::object& progress) {
  TraceOptions options = options_of(handle, given);
  if (!handle.branch().checkpoint)
    throw py::value_error("resume: the branch has come to its end; there is nothing further");
  const CurveUse alone(handle.curve_flag());
  const Stopwatch watch;
  Branch after = in_engine(options, progress, [&](const auto& observer) {
    const continuation::Checkpoint& checkpoint = *handle.branch().checkpoint;
    return handle.curve()
               ? continuation::resume(*handle.curve(), checkpoint, options, observer,
                                      handle.traced().request->cycles.options)
               : continuation::resume(*handle.traced().base.problem, checkpoint, options, observer);
  });
  return std::make_shared<BranchHandle>(
      beside(handle, options, joined(handle.branch(), std::move(after)),
             handle.traced().seconds + watch.seconds(), handle.traced().base.problem, handle.traced().curve),
      handle);
}

/// From a text that was kept: the points that follow.
std::shared_ptr<BranchHandle> trace_on(const std::shared_ptr<PythonProblem>& problem, const std::string& text,
                                       const py::dict& given, const py::object& progress) {
  TraceOptions options;
  set_options(given, problem, options);
  std::istringstream in(text);
  const continuation::Checkpoint checkpoint = [&] {
    try {
      return continuation::read_checkpoint(in);
    } catch (const std::runtime_error& error) {
      throw py::value_error(fmt::format("checkpoint: {}", error.what()));
    }
  }();
  const Stopwatch watch;
  Branch branch = in_engine(options, progress, [&](const auto& observer) {
    return continuation::resume(*traced_problem(problem), checkpoint, options, observer);
  });
  TracedBranch traced = traced_of(problem, options, std::move(branch));
  traced.seconds = watch.seconds();
  return std::make_shared<BranchHandle>(std::move(traced), problem);
}

Step step_named(const std::string& name) {
  if (name == "given") return Step::none;
  if (name == "complex step") return Step::complex;
  return Step::central;
}

std::shared_ptr<PythonProblem> make_problem(const py::dict& functions, const py::dict& traits,
                                            const py::object& u, const py::object& p) {
  const auto function = [&](const char* name) { return functions[name].cast<py::object>(); };
  PythonTraits made;
  made.size = traits["size"].cast<Index>();
  made.parameters = traits["parameters"].cast<std::vector<std::string>>();
  made.form = traits["form"].cast<std::string>();
  made.unknowns = traits["unknowns"].cast<std::vector<std::string>>();
  made.observables = traits["observables"].cast<std::vector<std::string>>();
  made.active = traits["active"].cast<std::vector<std::string>>();
  made.sparse = traits["sparse"].cast<bool>();
  made.is_equilibrium = traits["equilibrium"].cast<bool>();
  made.switches = traits["switches"].cast<Index>();
  made.unknown_scale = take_all(traits["unknown_scale"], "unknown_scale");
  made.parameter_scale = take_all(traits["parameter_scale"], "parameter_scale");
  made.scales_by_ranges = traits["scales_by_ranges"].cast<bool>();
  made.by_unknowns = step_named(traits["jacobian"].cast<std::string>());
  made.by_parameters = step_named(traits["parameter_jacobian"].cast<std::string>());
  made.of_observables = step_named(traits["of_observables"].cast<std::string>());
  if (const py::object formulas = traits["formulas"]; !formulas.is_none())
    made.formulas = formulas.cast<const Formulas&>().problem;
  made.of_borders = step_named(traits["of_borders"].cast<std::string>());
  return std::make_shared<PythonProblem>(
      PythonFunctions{function("residual"), function("jacobian"), function("parameter_jacobian"),
                      function("observables"), function("eigenvalues"), function("borders"),
                      function("beyond")},
      std::move(made), take_all(u, "u0"), take_all(p, "p0"));
}

}  // namespace

void bind_trace(py::module_& module) {
  py::class_<PythonProblem, std::shared_ptr<PythonProblem>>(module, "Problem").def(py::init(&make_problem));
  module.def("trace",
             [](const std::shared_ptr<PythonProblem>& problem, const py::object& u, const py::object& p,
                const py::object& regime, const std::string& how, const py::object& lower,
                const py::object& upper, bool check, const py::dict& options, const py::object& progress) {
               return trace(problem, u, p, regime, how, box_of(lower, upper), check, options, progress);
             });
  module.def("start_from", start_from);
  module.def("switch_at", switch_at);
  module.def("curve_through", curve_through);
  module.def("resume", resume);
  module.def("trace_on", trace_on);
}

}  // namespace arcslip::python
