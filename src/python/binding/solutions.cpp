#include "python/binding/solutions.hpp"

#include <pybind11/stl.h>

#include <tuple>

#include "arcslip/continuation/path/all_solutions.hpp"
#include "arcslip/problems/tasks/all_solutions.hpp"
#include "python/binding/formulas.hpp"
#include "python/binding/tracing.hpp"

namespace arcslip::python {
namespace {

using continuation::Guess;

/// The solutions, whether these are all in the box, and why.
py::tuple solve_all(const std::shared_ptr<PythonProblem>& problem, const py::object& formulas,
                    const std::vector<py::object>& starts, const py::object& p, const py::object& regime,
                    const py::object& lower, const py::object& upper, int count) {
  std::vector<Guess> guesses;
  guesses.reserve(starts.size());
  for (const py::object& start : starts) guesses.push_back(guess_of(*problem, start, p, regime));
  continuation::SolveAllOptions seeking;
  std::tie(seeking.lower, seeking.upper) = box_of(lower, upper);
  seeking.starts = count;
  EnclosedMap map;
  if (!formulas.is_none()) {
    if (const auto system = formulas.cast<const Formulas&>().problem)
      map = system->enclosed(guesses.front().parameters);
  }
  continuation::TraceOptions options;
  const problems::AllSolutions found = in_engine(options, py::none(), [&](const auto&) {
    seeking.go_on = options.go_on;
    return problems::find_all_solutions(*traced_problem(problem), guesses, seeking, map);
  });
  py::list all;
  for (const Guess& solution : found.solutions) all.append(give(solution.unknowns));
  const std::optional<bool>& complete = found.count.complete;
  return py::make_tuple(all, complete ? py::object(py::bool_(*complete)) : py::none(), found.count.reason);
}

}  // namespace

void bind_solutions(py::module_& module) { module.def("solve_all", solve_all); }

}  // namespace arcslip::python
