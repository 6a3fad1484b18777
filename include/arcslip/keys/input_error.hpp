#pragma once

#include <stdexcept>

namespace arcslip {

/// Wrong input, in one line: file, line, column, key, what was expected, what was given.
class InputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace arcslip
