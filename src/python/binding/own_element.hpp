#pragma once

// Elements beside the contacts whose force is written in Python.

#include <memory>

#include "arcslip/elements/element_kind.hpp"
#include "python/binding/raised.hpp"

namespace arcslip::python {

/// The kind that an arcslip.Element is. Throws py::value_error where there is one of its name.
std::shared_ptr<const ElementKind> kind_of(const py::object& element, const std::shared_ptr<Raised>& raised);

}  // namespace arcslip::python
