#pragma once

// Points and branches that are the same to the last bit.

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

/// A branch that was left and gone on with is the whole one.
inline void check_gone_on(const continuation::Branch& first, const continuation::Branch& rest,
                          const continuation::Branch& whole) {
  CHECK(rest.stop == whole.stop);
  REQUIRE(first.points.size() + rest.points.size() == whole.points.size());
  for (std::size_t i = 0; i < first.points.size(); ++i) check_same(first.points[i], whole.points[i]);
  for (std::size_t i = 0; i < rest.points.size(); ++i)
    check_same(rest.points[i], whole.points[first.points.size() + i]);
}

}  // namespace arcslip::testing
