#pragma once

// All solutions of F(u, p) = 0 at one p, and what is known of their list.

#include <optional>
#include <string>
#include <vector>

#include "arcslip/continuation/path/all_solutions.hpp"
#include "arcslip/interval/zeros_in_box.hpp"

namespace arcslip::problems {

/// What is known of a list of solutions.
struct SolutionCount {
  std::size_t count = 0;  ///< that were found, in and outside of the box
  std::optional<bool>
      complete;        ///< true: there are no others in the box; false: there must be; none: unknown
  std::string reason;  ///< of that, a clause
  Box box;             ///< of the unknowns; empty where none was looked through
};

/// The solutions with what is known of their list.
struct AllSolutions {
  std::vector<continuation::Guess> solutions;  ///< in the order found
  SolutionCount count;
};

/// By deflation and branches from guesses, of which there has to be one, and from starts in the options' box,
/// which is `widened` to hold all that is found; by interval arithmetic as well where F is `enclosed` at p.
AllSolutions find_all_solutions(const continuation::Problem& problem,
                                const std::vector<continuation::Guess>& guesses,
                                const continuation::SolveAllOptions& options,
                                const EnclosedMap& enclosed = {}, bool widened = false);

}  // namespace arcslip::problems
