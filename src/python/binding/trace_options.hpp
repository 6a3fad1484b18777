#pragma once

// What is traced, looked for and enough, as keyword arguments.

#include "arcslip/continuation/path/trace.hpp"
#include "python/binding/python_problem.hpp"

namespace arcslip::python {

/// Sets those that are given. Events are functions of the problem that is written in Python, which must
/// outlive the options. Throws py::value_error that names the key.
void set_options(const py::dict& given, const std::shared_ptr<PythonProblem>& problem,
                 continuation::TraceOptions& options);

}  // namespace arcslip::python
