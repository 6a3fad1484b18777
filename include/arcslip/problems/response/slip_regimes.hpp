#pragma once

// Regimes of m contacts, each of which sticks or slips: switch i of a regime is in state 1 where contact i
// slips. A contact changes over where its amplitude A = max |r(t)| is S.

#include <string>

#include "arcslip/continuation/problem/regime.hpp"
#include "arcslip/types.hpp"

namespace arcslip::problems {

inline std::size_t at(Index i) { return static_cast<std::size_t>(i); }

inline bool slips(const continuation::Regime& regime, Index contact) { return regime[contact] != 0; }
inline bool all_stick(const continuation::Regime& regime) { return regime == continuation::Regime(); }

/// "stick", "slip", or "slip 1 3" where only these of `contacts` slip; of more than twelve how many do, and
/// four hexadecimal figures that tell patterns apart: "slip 37 of 100 #5c1e".
std::string slip_name(const continuation::Regime& regime, Index contacts);

}  // namespace arcslip::problems
