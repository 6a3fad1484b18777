#pragma once

// A traced branch as Python has it, of a case file or of a problem written in Python.

#include <atomic>
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

/// A curve's problem has a state, which serves one thread: while this lives, no other.
class CurveUse {
 public:
  /// Without a flag there is nothing to be alone with. Throws std::runtime_error where another thread is.
  explicit CurveUse(std::atomic<bool>* flag);
  ~CurveUse();
  CurveUse(const CurveUse&) = delete;
  CurveUse& operator=(const CurveUse&) = delete;
  CurveUse(CurveUse&&) = delete;
  CurveUse& operator=(CurveUse&&) = delete;

 private:
  std::atomic<bool>* flag_;
};

class BranchHandle {
 public:
  /// `problem` is what the branch is one of where that is written in Python, else null.
  BranchHandle(TracedBranch traced, std::shared_ptr<PythonProblem> problem);
  /// The same curve, or branch, gone on with.
  BranchHandle(TracedBranch traced, const BranchHandle& beside);

  const TracedBranch& traced() const { return traced_; }
  const continuation::Branch& branch() const { return traced_.branch; }
  const std::shared_ptr<PythonProblem>& problem() const { return problem_; }
  /// Of a curve in two parameters its problem, else null; to be used by itself, see CurveUse.
  continuation::ExtendedProblem* curve() const { return curve_.get(); }
  std::atomic<bool>* curve_flag() const { return curve_used_.get(); }
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
  std::shared_ptr<std::atomic<bool>> curve_used_;
  std::shared_ptr<const Table> table_;
  std::optional<Matrix> unknowns_;
  std::optional<Matrix> tangents_;
  std::optional<Matrix> parameters_;
};

template <class Work>
auto BranchHandle::heard(const Work& work) const {
  const CurveUse alone(curve_flag());
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
