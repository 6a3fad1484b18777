#pragma once

// What tracing from Python has in common.

#include <pybind11/stl.h>

#include <chrono>
#include <utility>

#include "python/binding/branch.hpp"

namespace arcslip::python {

using Handles = std::vector<std::shared_ptr<BranchHandle>>;

/// How long it has been there, s.
class Stopwatch {
 public:
  double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begun_).count();
  }

 private:
  std::chrono::steady_clock::time_point begun_ = std::chrono::steady_clock::now();
};

/// What stands for the library's model where a problem is written in Python.
inline const std::shared_ptr<const problems::LibraryModel> written_in_python =
    std::make_shared<const problems::LibraryModel>(
        problems::LibraryModel{"python", "written in Python", {}, {}, {}});

/// Work of the engine without the lock; `observer` of it is told of each point.
template <class Work>
auto in_engine(continuation::TraceOptions& options, const py::object& progress, const Work& work) {
  Interruption interruption(progress);
  const PythonProblem::Listener listener(interruption);
  options.go_on = [&] { return interruption.go_on(); };
  std::size_t points = 0;
  const continuation::Observer observer = [&](const continuation::BranchPoint& point) {
    ++points;
    return interruption.go_on([&] { return py::make_tuple(0, 1, points, point.arclength); });
  };
  auto result = [&] {
    try {
      const py::gil_scoped_release released;
      return work(observer);
    } catch (...) {
      interruption.rethrow();  // what came first
      throw;
    }
  }();
  options.go_on = {};
  interruption.rethrow();
  return result;
}

inline TracedBranch traced_of(const std::shared_ptr<PythonProblem>& problem,
                              const continuation::TraceOptions& options, continuation::Branch branch,
                              const continuation::OrbitOptions& orbits = {}) {
  auto request = std::make_shared<CaseBranch>();
  request->values = nlohmann::ordered_json::object();
  request->problem.model = written_in_python;
  request->options = options;
  request->options.go_on = {};
  request->cycles.options = orbits;
  TracedBranch traced;
  traced.request = request;
  traced.base.problem = traced_problem(problem);
  traced.branch = std::move(branch);
  return traced;
}

/// As the engine takes it. Throws py::value_error.
inline continuation::Guess guess_of(const PythonProblem& problem, const py::handle& u, const py::handle& p,
                                    const py::handle& regime) {
  continuation::Guess guess;
  guess.unknowns.resize(problem.size());
  take(u, "u0", guess.unknowns);
  guess.parameters.resize(std::ssize(problem.traits().parameters));
  take(p, "p0", guess.parameters);
  guess.regime = problem.to_regime(regime);
  return guess;
}

/// The range that unknowns are kept in, empty without one. Throws py::value_error.
inline std::pair<Vector, Vector> box_of(const py::handle& lower, const py::handle& upper) {
  if (lower.is_none()) return {};
  return {take_all(lower, "box"), take_all(upper, "box")};
}

}  // namespace arcslip::python
