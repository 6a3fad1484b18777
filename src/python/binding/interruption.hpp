#pragma once

// Long work without the interpreter's lock: Ctrl-C and a user's report of progress reach it all the same.

#include <pybind11/pybind11.h>

#include <chrono>
#include <exception>
#include <functional>

#include "python/binding/own_element.hpp"

namespace arcslip::python {

/// Asked by work that holds no lock, from the thread that called it. Twenty times a second it takes the lock
/// for a moment.
class Interruption {
 public:
  /// What is told of progress, as arguments of the user's function; called with the lock held.
  using Tell = std::function<py::tuple()>;

  /// `progress` is called with what `tell` says, or is None; what elements of a case raise ends the work.
  explicit Interruption(py::object progress = py::none(), std::shared_ptr<Raised> raised = {})
      : progress_(std::move(progress)), raised_(std::move(raised)) {}

  /// Whether the work is to go on: not after Ctrl-C, nor after something was raised.
  bool go_on() { return go_on({}); }
  bool go_on(const Tell& tell) {
    if (raised_ && raised_->interrupted.exchange(false)) interrupt();
    return !is_stopped() && !(raised_ && raised_->is_any()) && look(tell);
  }

  /// Ends the work as Ctrl-C does, and as an exception does that is raised where the work has ended.
  void interrupt() { interrupted_ = true; }
  void fail(std::exception_ptr error);

  bool interrupted() const { return interrupted_; }
  bool is_stopped() const { return interrupted_ || error_ != nullptr; }

  /// Throws what was raised on the way, once. With the lock held.
  void rethrow();

 private:
  bool look(const Tell& tell);

  py::object progress_;
  std::shared_ptr<Raised> raised_;
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
  std::chrono::steady_clock::time_point told_ = last_;
  bool interrupted_ = false;
  std::exception_ptr error_;
};

/// Takes what Python has raised: KeyboardInterrupt ends the work as Ctrl-C does, all else is kept to be
/// raised again with its traceback. With the lock held, in a catch clause.
void note_raised(Interruption& interruption, py::error_already_set& raised);

}  // namespace arcslip::python
