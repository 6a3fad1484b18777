#pragma once

// A traced branch as Python has it, of a case file or of a problem written in Python.

#include <memory>
#include <optional>

#include "arcslip/cases/runs.hpp"
#include "arcslip/results/results.hpp"
#include "python/binding/arrays.hpp"
#include "python/binding/interruption.hpp"
#include "python/binding/python_problem.hpp"

namespace arcslip::python {

/// Columns by name, of points or of samples.
struct Table {
  std::vector<std::string> names;
  Matrix values;  ///< rows x names
};

class BranchHandle {
 public:
  /// `problem` is what the branch is one of where that is written in Python, `curve` where it is a curve.
  BranchHandle(TracedBranch traced, std::shared_ptr<PythonProblem> problem,
               std::shared_ptr<continuation::ExtendedProblem> curve);

  const TracedBranch& traced() const { return traced_; }
  const continuation::Branch& branch() const { return traced_.branch; }
  const std::shared_ptr<PythonProblem>& problem() const { return problem_; }
  const std::shared_ptr<continuation::ExtendedProblem>& curve() const { return curve_; }
  Index parameter() const;
  const continuation::BranchPoint& point(std::size_t i) const;

  // Each is made once, when it is first asked for.
  const Table& table();
  const Matrix& unknowns();    ///< n x points
  const Matrix& tangents();    ///< (n + 1) x points
  const Matrix& parameters();  ///< all x points

  /// Of points that are not the branch's own.
  Table tabulate(const std::vector<continuation::BranchPoint>& points, BranchTable::Detail detail) const;

  /// Throws what the problem's functions raise meanwhile.
  template <class Work>
  auto heard(const Work& work) const;

 private:
  TracedBranch traced_;
  std::shared_ptr<PythonProblem> problem_;
  std::shared_ptr<continuation::ExtendedProblem> curve_;
  std::shared_ptr<const Table> table_;
  std::optional<Matrix> unknowns_;
  std::optional<Matrix> tangents_;
  std::optional<Matrix> parameters_;
};

template <class Work>
auto BranchHandle::heard(const Work& work) const {
  Interruption interruption;
  const PythonProblem::Listener listener(interruption);
  auto result = work();
  interruption.rethrow();
  if (interruption.interrupted()) {
    PyErr_SetNone(PyExc_KeyboardInterrupt);
    throw py::error_already_set();
  }
  return result;
}

/// Without what only the work knew that traced it.
BranchHandle settled(TracedBranch traced);

void bind_branch(py::module_& module);

}  // namespace arcslip::python
