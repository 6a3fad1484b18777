#pragma once

// Curves of special cycles from where they begin on curves of Hopf points, at small cycles, and from where
// others meet them.

#include "arcslip/continuation/curves/orbit_curve.hpp"

namespace arcslip::continuation {

/// The curves of special cycles that begin at a point of codimension two of a curve of Hopf points of the
/// field's equilibria [Yu. A. Kuznetsov, Elements of Applied Bifurcation Theory, 3rd ed., Springer 2004,
/// chapter 8]: of folds at a generalised Hopf point, and of Neimark-Sacker points of the cycles of each pair
/// at a double Hopf point, and at a zero-Hopf point where its normal form has them. None elsewhere.
std::vector<OrbitCurveStart> cycle_curves_from(const std::shared_ptr<const Field>& field,
                                               const ExtendedProblem& curve, const BranchPoint& point,
                                               const OrbitOptions& options = {});

/// The curves that meet one of special cycles at a point of codimension two: as
/// `multiplier_curve_meeting` has them, and of folds of the cycles of twice the period, which begins at a
/// generalised period doubling. None elsewhere.
std::vector<OrbitCurveStart> cycle_curves_meeting(const ExtendedProblem& curve, const BranchPoint& point);

}  // namespace arcslip::continuation
