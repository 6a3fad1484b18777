#pragma once

// Corners where pieces of several regimes meet.

#include "arcslip/continuation/path/trace.hpp"

namespace arcslip::continuation {

/// Borders closer than this are reached together.
inline constexpr double same_border = 1e-8;

/// All pieces of solution curves that leave a point on one or several borders into a regime's inside, of
/// every regime that the point belongs to: guesses with a direction, n + 1 in (u, p_a). The piece that leads
/// to the point is among them, backwards.
std::vector<Guess> leaving_pieces(const Problem& problem, Index parameter, const Guess& corner,
                                  double tolerance = same_border);

}  // namespace arcslip::continuation
