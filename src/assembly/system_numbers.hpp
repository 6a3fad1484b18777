#pragma once

#include "arcslip/assembly/system.hpp"
#include "arcslip/assembly/system_parameter.hpp"

namespace arcslip {

/// What another value of a number does to `at`, which holds what the system's own values do.
using Change = void (*)(SystemParameter::At& at, double value, const SystemParameters& system);

/// A parameter of a system that has this value of it.
SystemParameter system_number(const std::string& name, double own,
                              const std::function<void(SystemParameter::At&, double value)>& change,
                              SystemParameter::Kind kind,
                              const std::function<void(SystemParameters&, double value)>& set,
                              const SystemParameters& system);

/// One that is a number of the system.
SystemParameter system_number(const char* name, double SystemParameters::*member, Change change,
                              SystemParameter::Kind kind, const SystemParameters& system);

}  // namespace arcslip
