#pragma once

// The curves on a triangulated surface along which dF/du is singular.

#include "arcslip/continuation/atlas/zero_curves.hpp"

namespace arcslip::continuation {

/// A point on each edge at whose ends det dF/du has different signs, with cusps and the turning points in
/// either parameter between them, and one on each edge in which sheets cross. Serves one thread.
std::vector<AtlasFold> fold_curves(const Problem& problem, Surface& surface, const std::vector<Disc>& discs,
                                   ZeroCurves& zeros);

}  // namespace arcslip::continuation
