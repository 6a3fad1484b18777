#pragma once

// Base and damper whose responses are written in Python.

#include "arcslip/assembly/structures.hpp"
#include "python/binding/raised.hpp"

namespace arcslip::python {

/// What an arcslip.Structure is.
std::shared_ptr<const Structures> structures_of(const py::object& structure,
                                                const std::shared_ptr<Raised>& raised);

}  // namespace arcslip::python
