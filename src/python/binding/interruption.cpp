#include "python/binding/interruption.hpp"

#include <utility>

namespace arcslip::python {

void note_raised(Interruption& interruption, py::error_already_set& raised) {
  if (raised.matches(PyExc_KeyboardInterrupt)) {
    interruption.interrupt();
  } else {
    interruption.fail(std::current_exception());
  }
}

void Interruption::fail(std::exception_ptr error) {
  if (!error_) error_ = std::move(error);
}

void Interruption::rethrow() {
  if (error_) std::rethrow_exception(std::exchange(error_, nullptr));
}

bool Interruption::look(const Tell& tell) {
  constexpr std::chrono::milliseconds patience(50);
  const auto now = std::chrono::steady_clock::now();
  const bool tells = tell && !progress_.is_none() && now - told_ >= patience;
  if (!tells && now - last_ < patience) return true;
  last_ = now;
  if (tells) told_ = now;
  const py::gil_scoped_acquire lock;
  try {
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    if (tells) progress_(*tell());
  } catch (py::error_already_set& raised) {
    note_raised(*this, raised);
  }
  return !is_stopped();
}

}  // namespace arcslip::python
