#pragma once

// Points that are the same to the last bit.

#include "arcslip/continuation/path/branch.hpp"
#include "catch.hpp"

namespace arcslip::testing {

inline void check_same(const continuation::BranchPoint& a, const continuation::BranchPoint& b) {
  CHECK(a.type == b.type);
  CHECK(a.regime == b.regime);
  CHECK(a.unknowns == b.unknowns);
  CHECK(a.parameters == b.parameters);
  CHECK(a.arclength == b.arclength);
  CHECK(a.residual == b.residual);
  CHECK(a.tangent == b.tangent);
}

}  // namespace arcslip::testing
