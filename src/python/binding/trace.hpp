#pragma once

// Problems written in Python traced, and branches gone on with, switched, and followed in two parameters.

#include "python/binding/branch.hpp"

namespace arcslip::python {

void bind_trace(py::module_& module);

}  // namespace arcslip::python
