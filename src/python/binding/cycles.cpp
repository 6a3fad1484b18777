#include "python/binding/cycles.hpp"

#include "arcslip/continuation/cycles/settled_cycle.hpp"
#include "cases/cycles.hpp"
#include "python/binding/formulas.hpp"
#include "python/binding/timed_field.hpp"
#include "python/binding/trace_options.hpp"
#include "python/binding/tracing.hpp"
#include "results/run_progress.hpp"

namespace arcslip::python {
namespace {

/// What a flow's cycles are those of.
std::shared_ptr<const continuation::Field> field_of(
    const std::shared_ptr<PythonProblem>& problem, const std::shared_ptr<const continuation::Field>& forced) {
  if (forced) return forced;
  return std::make_shared<continuation::EquilibriumField>(traced_problem(problem));
}

struct FoundCycles {
  std::vector<continuation::CycleBranch> branches;
  std::string doubt;  ///< about the Hopf points that they leave: why some may be missing; empty without
};

/// The cycles that leave the Hopf points of the branch next to a guess or, with a time to settle, that which
/// a motion from it comes to; and with `follow` all that can be reached from these.
FoundCycles traced_cycles(const std::shared_ptr<const continuation::Field>& field,
                          const continuation::Problem& problem, const continuation::Guess& guess,
                          const std::optional<double>& settle, bool follow, bool both,
                          const continuation::TraceOptions& options, const continuation::CycleOptions& cycles,
                          const continuation::Observer& observer) {
  if (!settle && !field->is_periodic()) {
    const continuation::TraceOptions unseen = unwatched(options);
    const continuation::Branch equilibria =
        both ? continuation::trace_both(problem, guess, unseen) : continuation::trace(problem, guess, unseen);
    if (equilibria.stop == continuation::Stop::no_start) throw std::invalid_argument(equilibria.explanation);
    return {trace_cycles_leaving(field, {equilibria}, options, cycles, observer, follow),
            doubt_about(equilibria)};
  }
  continuation::CycleStart start =
      settled_cycle(field, guess.unknowns, guess.parameters, settle, cycles, options.go_on);
  start.both_ways = both;
  if (follow) return {trace_connected_cycles(start, options, cycles, observer), ""};
  return {{continuation::trace_cycles(start, options, cycles, observer)}, ""};
}

continuation::OrbitOptions held_on(const py::dict& held) {
  continuation::OrbitOptions orbits;
  if (held.contains("balance")) {
    orbits.trigonometric = held["balance"].cast<bool>();
    orbits.waves = held["harmonics"].cast<int>();
  }
  orbits.intervals = held["intervals"].cast<Index>();
  orbits.degree = held["degree"].cast<int>();
  orbits.tolerance = held["tolerance"].cast<double>();
  orbits.doublings = held["doublings"].cast<int>();
  orbits.max_branches = held["max_branches"].cast<std::size_t>();
  return orbits;
}

template <class OneBranch>
Handles handles_of(const std::shared_ptr<PythonProblem>& problem, const continuation::TraceOptions& options,
                   const continuation::OrbitOptions& orbits, const std::vector<OneBranch>& branches,
                   const Stopwatch& watch) {
  Handles handles;
  for (const OneBranch& one : branches) {
    TracedBranch traced = traced_of(problem, options, one.branch, orbits);
    traced.base.problem = one.problem;
    traced.seconds = watch.seconds() / static_cast<double>(branches.size());
    handles.push_back(std::make_shared<BranchHandle>(std::move(traced), problem));
  }
  return handles;
}

/// The branches, and the doubt about the Hopf points.
py::tuple trace_cycles(const std::shared_ptr<PythonProblem>& problem, const py::object& formulas,
                       const py::handle& u, const py::handle& p, const std::optional<double>& settle,
                       const std::optional<std::string>& period, bool follow, const std::string& how,
                       const py::dict& given, const py::dict& held, const py::object& progress) {
  continuation::TraceOptions options;
  set_options(given, problem, options);
  const continuation::CycleOptions cycles = held_on(held);
  continuation::Guess guess = guess_of(*problem, u, p, py::int_(0));
  std::shared_ptr<const continuation::Field> forced;
  const auto take_up = [&](const auto& field) {
    field->require_period(guess.parameters);
    forced = field;
  };
  if (!formulas.is_none()) take_up(formulas.cast<const Formulas&>().forced);
  if (period) {
    guess.parameters.conservativeResize(guess.parameters.size() - 1);
    take_up(std::make_shared<const TimedField>(problem, *period));
  }
  const Stopwatch watch;
  const FoundCycles found = in_engine(options, progress, [&](const auto& observer) {
    return traced_cycles(field_of(problem, forced), *traced_problem(problem), guess, settle, follow,
                         how == "both", options, cycles, observer);
  });
  return py::make_tuple(handles_of(problem, options, cycles, found.branches, watch), found.doubt);
}

/// The branch of what has orbits alone from its guess, or what motions come to, and, with `follow`, all that
/// can be reached from it.
Handles trace_orbit(const std::shared_ptr<PythonProblem>& problem, const Formulas& formulas,
                    const py::handle& p, const std::optional<double>& settle, bool follow,
                    const std::string& how, const py::dict& given, const py::dict& held,
                    const py::object& progress) {
  continuation::TraceOptions options;
  set_options(given, problem, options);
  const continuation::OrbitOptions orbits = held_on(held);
  const std::vector<std::string>& names = problem->traits().parameters;
  Vector values(std::ssize(names));
  take(p, "p0", values);
  problems::LibraryModel::Values settings;
  for (const Setting& setting : formulas.orbits->settings)
    settings.push_back(values(continuation::index_of(names, setting.name)));
  continuation::OrbitStart start = formulas.orbits->orbit(settings, orbits, settle);
  continuation::index_of(start.problem->parameter_names(), options.parameter);
  start.both_ways = how == "both";
  const Stopwatch watch;
  const auto branches = in_engine(options, progress, [&](const auto& observer) {
    if (follow) return trace_connected_orbits(start, options, orbits, observer);
    return std::vector{trace_orbits(start, options, orbits, observer)};
  });
  return handles_of(problem, options, orbits, branches, watch);
}

/// A point of a branch of orbits, or of a curve of special ones in two parameters, and what it solves; null
/// where that is no problem of orbits.
struct OrbitPoint {
  const continuation::OrbitProblem* orbits;
  continuation::BasePoint at;
};
OrbitPoint orbit_point(const BranchHandle& handle, std::size_t i) {
  const continuation::BranchPoint& point = handle.point(i);
  if (handle.curve() == nullptr)
    return {orbits_of(handle.traced()), {point.unknowns, point.parameters, point.regime, {}}};
  return {dynamic_cast<const continuation::OrbitProblem*>(&handle.curve()->base()),
          handle.curve()->split(point.unknowns, point.parameters, point.regime)};
}

/// The orbit of a point: what its times are called, these, unknowns x times, their names.
py::tuple orbit_of(const BranchHandle& handle, std::size_t i) {
  const auto [orbits, at] = orbit_point(handle, i);
  if (orbits == nullptr)
    throw py::value_error("orbit: only of branches of cycles and of boundary value problems");
  return py::make_tuple(orbits->time_name(), give(orbits->times(at.unknowns, at.parameters, at.regime)),
                        give(orbits->told_orbit(at.unknowns)), orbits->told_names());
}

/// The Floquet multipliers of a point as their logarithms.
py::array log_multipliers_of(const BranchHandle& handle, std::size_t i) {
  const OrbitPoint point = orbit_point(handle, i);
  const continuation::BasePoint& at = point.at;
  if (point.orbits == nullptr || point.orbits->pair_crossing() != continuation::PointType::neimark_sacker)
    throw py::value_error("multipliers: only of branches of cycles");
  return give(
      handle.heard([&] { return point.orbits->log_multipliers(at.unknowns, at.parameters, at.regime); }));
}

}  // namespace

void bind_cycles(py::module_& module) {
  module.def("trace_cycles", trace_cycles);
  module.def("trace_orbit", trace_orbit);
  module.def("orbit_of", orbit_of);
  module.def("log_multipliers_of", log_multipliers_of);
}

}  // namespace arcslip::python
