#pragma once

#include <pybind11/pybind11.h>

namespace arcslip::python {

/// Adds `cover`: surfaces of solutions over two parameters.
void bind_surface(pybind11::module_& module);

}  // namespace arcslip::python
