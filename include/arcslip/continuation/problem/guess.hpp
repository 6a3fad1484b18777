#pragma once

// Where a branch starts.

#include "arcslip/continuation/problem/regime.hpp"
#include "arcslip/types.hpp"

namespace arcslip::continuation {

/// A guess of the unknowns at the given parameters, in a regime.
struct Guess {
  Vector unknowns;     ///< n
  Vector parameters;   ///< all of the problem's
  Regime regime = {};  ///< in which it lies
  /// n + 1, in (u, p_a), of any length: the branch starts right here and goes this way. Empty: it starts at
  /// `TraceOptions::from` and goes towards `to`.
  Vector direction = {};
};

}  // namespace arcslip::continuation
