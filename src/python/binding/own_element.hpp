#pragma once

// Elements beside the contacts whose force is written in Python.

#include <pybind11/pybind11.h>

#include <atomic>
#include <exception>
#include <memory>
#include <mutex>

#include "arcslip/elements/element_kind.hpp"

namespace arcslip::python {

namespace py = pybind11;

/// The first thing that the elements of a case raised, in whatever thread, and whether Ctrl-C reached one.
class Raised {
 public:
  void note(std::exception_ptr error);
  bool is_any() const { return any_; }
  /// Throws it, once. With the lock held.
  void rethrow();

  std::atomic<bool> interrupted = false;

 private:
  std::mutex mutex_;
  std::exception_ptr error_;
  std::atomic<bool> any_ = false;
};

/// The kind that an arcslip.Element is. Throws py::value_error where there is one of its name.
std::shared_ptr<const ElementKind> kind_of(const py::object& element, const std::shared_ptr<Raised>& raised);

}  // namespace arcslip::python
