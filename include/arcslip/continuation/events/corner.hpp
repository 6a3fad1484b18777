#pragma once

// Corners where pieces of several regimes meet.

#include "arcslip/continuation/path/trace.hpp"

namespace arcslip::continuation {

/// As many borders that are reached together are told apart by trying all patterns of their switches.
inline constexpr int most_exact = 8;

/// All pieces of solution curves that leave a point on one or several borders into a regime's inside, of
/// every regime that the point belongs to: guesses with a direction, n + 1 in (u, p_a). The piece that leads
/// to the point is among them, backwards.
///
/// The regimes are those beyond the borders that are reached, and no others. Where these are more than
/// `most_exact` only two pieces are looked for, that on which a branch in the corner's regime comes and that
/// on which it goes on: as F is continuous, the determinant that the tangent closes keeps its sign. Borders
/// that a piece runs beyond are crossed, all at first, then the first again and again, which ends where all
/// pieces turn the same way [Murty 1974], as a rule in as many rounds as borders; it is given up after the
/// square of that.
[[nodiscard]] std::vector<Guess> leaving_pieces(const Problem& problem, Index parameter, const Guess& corner,
                                                const Tolerances& tolerances = {});

}  // namespace arcslip::continuation
