#pragma once

// Python functions that the work of a case calls, from whatever thread.

#include <pybind11/pybind11.h>

#include <atomic>
#include <exception>
#include <memory>
#include <mutex>

namespace arcslip::python {

namespace py = pybind11;

/// The first thing that the functions of a case raised, in whatever thread, and whether Ctrl-C reached one.
class Raised {
 public:
  void note(std::exception_ptr error);
  bool is_any() const { return any_; }
  /// Throws it, once. With the lock held.
  void rethrow();

  /// Runs `work` with the lock, anew where Ctrl-C ended it; notes what it raises, and throws it.
  template <class Work>
  void watch(const Work& work) {
    const py::gil_scoped_acquire lock;
    try {
      try {
        work();
      } catch (py::error_already_set& error) {
        if (!error.matches(PyExc_KeyboardInterrupt)) throw;
        interrupted = true;  // all work ends at its next point
        work();
      }
    } catch (...) {
      note(std::current_exception());
      throw;
    }
  }

  std::atomic<bool> interrupted = false;

 private:
  std::mutex mutex_;
  std::exception_ptr error_;
  std::atomic<bool> any_ = false;
};

/// What may be dropped by threads without the interpreter's lock.
std::shared_ptr<const py::object> kept(const py::object& object);

}  // namespace arcslip::python
