#pragma once

// A response solved anew in other harmonics, which tells how far those that it has suffice.

#include <optional>

#include "arcslip/problems/response/harmonic_problem.hpp"

namespace arcslip::problems {

/// The same motion in the harmonics of another problem, maybe over more periods of the load, those that are
/// new being zero.
continuation::Guess carried(const HarmonicProblem& from, const continuation::Guess& at,
                            const HarmonicProblem& to);

/// The response of `to` at the same parameters to which Newton's method comes from there, in the regime in
/// which it finds its contacts; none where it comes to none.
[[nodiscard]] std::optional<continuation::Guess> solved_in(const HarmonicProblem& to,
                                                           const HarmonicProblem& from,
                                                           const continuation::Guess& at);

}  // namespace arcslip::problems
