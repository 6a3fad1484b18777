// The extension module arcslip._core, of which the package in src/python/arcslip is the face.

#include "python/binding/branch.hpp"
#include "python/binding/cases.hpp"
#include "python/binding/cycles.hpp"
#include "python/binding/formulas.hpp"
#include "python/binding/solutions.hpp"
#include "python/binding/surface.hpp"
#include "python/binding/trace.hpp"

PYBIND11_MODULE(_core, module) {
  module.doc() = "The C++ side of arcslip.";
  arcslip::python::bind_branch(module);
  arcslip::python::bind_cases(module);
  arcslip::python::bind_cycles(module);
  arcslip::python::bind_formulas(module);
  arcslip::python::bind_solutions(module);
  arcslip::python::bind_surface(module);
  arcslip::python::bind_trace(module);
}
