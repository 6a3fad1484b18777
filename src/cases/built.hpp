#pragma once

// What kinds of response have in common when they are built.

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "arcslip/assembly/system_parameter.hpp"
#include "arcslip/cases/runs.hpp"

namespace arcslip {

/// A problem in several harmonics that guesses from the values of all its parameters.
template <class Type>
Built built_in_harmonics(std::shared_ptr<const Type> problem) {
  const auto guess = [problem](const Built::ValueOf& value, const continuation::TraceOptions& limits) {
    const std::vector<std::string> names = problem->parameter_names();
    Vector parameters(std::ssize(names));
    std::transform(names.begin(), names.end(), parameters.begin(), value);
    return problem->guess(parameters, limits);
  };
  return {problem, guess, problem->system().orders};
}

/// eta, P and those of the system.
inline std::vector<std::string> forced_parameters() {
  std::vector<std::string> names = system_parameter_names();
  names.insert(names.begin(), {"eta", "P"});
  return names;
}

}  // namespace arcslip
