#pragma once

// Cycles of flows, traced from Python.

#include "python/binding/arrays.hpp"

namespace arcslip::python {

namespace py = pybind11;

void bind_cycles(py::module_& module);

}  // namespace arcslip::python
