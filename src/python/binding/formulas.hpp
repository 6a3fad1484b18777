#pragma once

// Systems given by formulas: arcslip._core.Formulas, which arcslip.Model is made of.

#include <pybind11/pybind11.h>

#include <memory>

#include "arcslip/problems/formulas/formula_field.hpp"

namespace arcslip::python {

namespace py = pybind11;

/// A system with its guess of the start.
struct Formulas {
  std::shared_ptr<const problems::FormulaProblem>
      problem;                                           ///< of what is forced at t = 0, else at the left end
  std::shared_ptr<const problems::FormulaField> forced;  ///< else null
  Tape start;                                            ///< of the unknowns, by parameters
  std::optional<problems::LibraryModel> orbits;          ///< of what has orbits alone, no equilibria
};

void bind_formulas(py::module_& module);

}  // namespace arcslip::python
