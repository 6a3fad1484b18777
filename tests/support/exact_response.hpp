#pragma once

// What must hold of any response beside any structures.

#include "arcslip/continuation/problem/derivative_check.hpp"
#include "arcslip/problems/response/power_balance.hpp"
#include "catch.hpp"

namespace arcslip::testing {

/// Its derivatives are exact, what goes in comes out, by friction too, and base and damper move as told.
inline void check_exact(const problems::HarmonicResponse& problem, const continuation::Guess& at) {
  const auto [worst, where] = continuation::check_derivatives(problem, at.unknowns, at.parameters, at.regime);
  CAPTURE(where);
  CHECK(worst < 1e-6);
  const problems::PowerBalance balance =
      problems::power_balance(problem, at.unknowns, at.parameters, at.regime);
  CHECK(balance.error() < 1e-8);
  CHECK(balance.friction > .001 * balance.input);
  CHECK(problems::motion_error(problem, at.unknowns, at.parameters, at.regime) < 1e-8);
}

}  // namespace arcslip::testing
