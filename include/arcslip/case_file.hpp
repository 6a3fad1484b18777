#pragma once

// Case files: TOML 1.0, read and checked whole before anything runs.

#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "arcslip/continuation/trace.hpp"
#include "arcslip/system.hpp"

namespace arcslip {

/// Wrong input, in one line: file, line, column, key, what was expected, what was given.
class InputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// One branch that a case asks for.
struct CaseBranch {
  nlohmann::ordered_json values;  ///< what `for_each` sets on it, by key
  SystemParameters system;
  double eta = 0;  ///< the fixed frequency where P is the continuation parameter
  continuation::TraceOptions options;
};

struct Case {
  std::string title;
  nlohmann::ordered_json resolved;  ///< the input with its defaults filled in
  std::vector<CaseBranch> branches;
};

/// Reads `path`, with `--set` arguments "section.key=value" applied on top. Throws InputError.
Case read_case(const std::string& path, const std::vector<std::string>& settings = {});

/// "preload = 0.1" for the values of a branch; several are joined by commas, none gives "".
std::string describe(const nlohmann::ordered_json& values);

}  // namespace arcslip
