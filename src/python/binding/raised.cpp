#include "python/binding/raised.hpp"

#include <utility>

namespace arcslip::python {

void Raised::note(std::exception_ptr error) {
  const std::scoped_lock lock(mutex_);
  if (!error_) error_ = std::move(error);
  any_ = true;
}

void Raised::rethrow() {
  std::exception_ptr error;
  {
    const std::scoped_lock lock(mutex_);
    error = std::exchange(error_, nullptr);
    any_ = false;
  }
  if (error) std::rethrow_exception(error);
}

std::shared_ptr<const py::object> kept(const py::object& object) {
  return {new py::object(object), [](const py::object* last) {
            const py::gil_scoped_acquire lock;
            delete last;
          }};
}

}  // namespace arcslip::python
