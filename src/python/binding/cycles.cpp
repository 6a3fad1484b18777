#include "python/binding/cycles.hpp"

#include "arcslip/continuation/cycles/settled_cycle.hpp"
#include "cases/cycles.hpp"
#include "python/binding/formulas.hpp"
#include "python/binding/trace_options.hpp"
#include "python/binding/tracing.hpp"

namespace arcslip::python {
namespace {

/// What a flow's cycles are those of.
std::shared_ptr<const continuation::Field> field_of(
    const std::shared_ptr<PythonProblem>& problem, const std::shared_ptr<const continuation::Field>& forced) {
  if (forced) return forced;
  return std::make_shared<continuation::EquilibriumField>(problem);
}

/// The cycles that leave the Hopf points of the branch next to a guess or, with a time to settle, that which
/// a motion from it comes to; and with `follow` all that can be reached from these.
std::vector<continuation::CycleBranch> traced_cycles(const std::shared_ptr<const continuation::Field>& field,
                                                     const continuation::Problem& problem,
                                                     const continuation::Guess& guess,
                                                     const std::optional<double>& settle, bool follow,
                                                     bool both, const continuation::TraceOptions& options,
                                                     const continuation::CycleOptions& cycles,
                                                     const continuation::Observer& observer) {
  if (!settle && !field->is_periodic()) {
    const continuation::Branch equilibria = continuation::trace(problem, guess, unwatched(options));
    return trace_cycles_leaving(field, {equilibria}, options, cycles, observer);
  }
  continuation::CycleStart start =
      settled_cycle(field, guess.unknowns, guess.parameters, settle, cycles, options.go_on);
  start.both_ways = both;
  if (follow) return trace_connected_cycles(start, options, cycles, observer);
  return {continuation::trace_cycles(start, options, cycles, observer)};
}

Handles trace_cycles(const std::shared_ptr<PythonProblem>& problem, const py::object& formulas,
                     const py::handle& u, const py::handle& p, const std::optional<double>& settle,
                     bool follow, const std::string& how, const py::dict& given, const py::dict& held,
                     const py::object& progress) {
  continuation::TraceOptions options;
  set_options(given, problem, options);
  continuation::CycleOptions cycles;
  cycles.intervals = held["intervals"].cast<Index>();
  cycles.degree = held["degree"].cast<int>();
  cycles.tolerance = held["tolerance"].cast<double>();
  cycles.doublings = held["doublings"].cast<int>();
  cycles.max_branches = held["max_branches"].cast<std::size_t>();
  const continuation::Guess guess = guess_of(*problem, u, p, py::int_(0));
  std::shared_ptr<const continuation::Field> forced;
  if (!formulas.is_none()) forced = formulas.cast<const Formulas&>().forced;
  const auto branches = in_engine(options, progress, [&](const auto& observer) {
    return traced_cycles(field_of(problem, forced), *problem, guess, settle, follow, how == "both", options,
                         cycles, observer);
  });
  Handles handles;
  for (const continuation::CycleBranch& one : branches) {
    TracedBranch traced = traced_of(problem, options, one.branch);
    traced.base.problem = one.problem;
    handles.push_back(std::make_shared<BranchHandle>(std::move(traced), problem));
  }
  return handles;
}

/// Throws py::value_error that begins with what is asked for of others than cycles.
const continuation::CycleProblem& cycles_in(const BranchHandle& handle, const char* asked) {
  const continuation::CycleProblem* cycles = cycles_of(handle.traced());
  if (cycles == nullptr) throw py::value_error(std::string(asked) + ": only of branches of cycles");
  return *cycles;
}

/// The orbit of a point: times, then unknowns x times.
py::tuple orbit_of(const BranchHandle& handle, std::size_t i) {
  const continuation::CycleProblem& cycles = cycles_in(handle, "orbit");
  const continuation::BranchPoint& point = handle.point(i);
  return py::make_tuple(give(cycles.times(point.unknowns, point.parameters, point.regime)),
                        give(Matrix(cycles.orbit(point.unknowns))), cycles.field().names());
}

/// The Floquet multipliers of a point as their logarithms.
py::array log_multipliers_of(const BranchHandle& handle, std::size_t i) {
  const continuation::CycleProblem& cycles = cycles_in(handle, "multipliers");
  const continuation::BranchPoint& point = handle.point(i);
  return give(
      handle.heard([&] { return cycles.log_multipliers(point.unknowns, point.parameters, point.regime); }));
}

}  // namespace

void bind_cycles(py::module_& module) {
  module.def("trace_cycles", trace_cycles);
  module.def("orbit_of", orbit_of);
  module.def("log_multipliers_of", log_multipliers_of);
}

}  // namespace arcslip::python
