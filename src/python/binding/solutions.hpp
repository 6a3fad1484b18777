#pragma once

#include <pybind11/pybind11.h>

namespace arcslip::python {

/// Adds `solve_all`: all solutions at one value of the parameters.
void bind_solutions(pybind11::module_& module);

}  // namespace arcslip::python
