#pragma once

// What kinds of response have in common when they are built.

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "arcslip/assembly/system_parameter.hpp"
#include "arcslip/cases/runs.hpp"

namespace arcslip {

/// The values of all parameters of a problem.
inline Vector values_of(const continuation::Problem& problem, const Built::ValueOf& value) {
  const std::vector<std::string> names = problem.parameter_names();
  Vector parameters(std::ssize(names));
  std::transform(names.begin(), names.end(), parameters.begin(), value);
  return parameters;
}

/// A problem in several harmonics that guesses from the values of all its parameters.
template <class Type>
Built built_in_harmonics(std::shared_ptr<const Type> problem) {
  const auto guess = [problem](const Built::ValueOf& value, const continuation::TraceOptions& limits) {
    return problem->guess(values_of(*problem, value), limits);
  };
  return {problem, guess, problem->system().orders, nullptr, nullptr, problem->events()};
}

/// One of one contact in one harmonic, which guesses from P and one more parameter.
template <class Type>
Built built_of_one_contact(std::shared_ptr<const Type> problem, const char* other) {
  const auto guess = [problem, other](const Built::ValueOf& value,
                                      const continuation::TraceOptions& /*limits*/) {
    return problem->guess(value(other), value("P"));
  };
  return {problem, guess};
}

/// eta, P and those of the system.
inline std::vector<std::string> forced_parameters() {
  std::vector<std::string> names = system_parameter_names();
  names.insert(names.begin(), {"eta", "P"});
  return names;
}

/// Of vibration without force: one of its own, P and those of the system.
inline std::vector<std::string> free_parameters(const std::string& own) {
  std::vector<std::string> names = system_parameter_names();
  std::erase_if(names, [&](const std::string& name) { return name == own || name == "F"; });
  names.insert(names.begin(), {own, "P"});
  return names;
}

}  // namespace arcslip
