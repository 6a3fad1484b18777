#pragma once

// Regimes of m contacts, each of which sticks or slips: bit i of a regime says that contact i slips. A
// contact changes over where its amplitude A = max |r(t)| is S.

#include <string>
#include <vector>

#include "arcslip/types.hpp"

namespace arcslip::problems {

inline std::size_t at(Index i) { return static_cast<std::size_t>(i); }

inline bool slips(int regime, Index contact) { return (regime >> contact & 1) != 0; }

/// "stick", "slip", or "slip 1 3" where only these contacts slip, for all regimes of `contacts`.
std::vector<std::string> slip_regimes(Index contacts);

}  // namespace arcslip::problems
