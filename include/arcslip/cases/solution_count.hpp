#pragma once

// How many solutions were found at one value of the parameter, and whether these are all.

#include <optional>
#include <string>

#include "arcslip/interval/zeros_in_box.hpp"

namespace arcslip {

/// What is known of a list of solutions.
struct SolutionCount {
  std::size_t count = 0;  ///< that were found, in and outside of the box
  std::optional<bool>
      complete;        ///< true: there are no others in the box; false: there must be; none: unknown
  std::string reason;  ///< of that, a clause
  Box box;             ///< of the unknowns; empty where none was looked through
};

}  // namespace arcslip
