#pragma once

// Case files from Python: run, study, check.

#include "python/binding/branch.hpp"

namespace arcslip::python {

void bind_cases(py::module_& module);

}  // namespace arcslip::python
