#pragma once

// The curves on a triangulated surface along which an observable is extremal over the first parameter.

#include "arcslip/continuation/atlas/zero_curves.hpp"

namespace arcslip::continuation {

/// A point on each edge at whose ends the slope of Y along the branch at one value of p_b differs in sign,
///
///   dY . t = 0,   t in the tangent plane with dp_b = 0,
///
/// with the turning points in p_b between them, where a peak and a trough meet. Serves one thread.
std::vector<AtlasRidge> ridges(const Problem& problem, Surface& surface, const std::vector<Disc>& discs,
                               ZeroCurves& zeros, const std::vector<std::string>& observables);

}  // namespace arcslip::continuation
