#pragma once

// Curves of folds and of Hopf points from where they meet: at Bogdanov-Takens and zero-Hopf points each
// other, at double Hopf points two of the latter; where a symmetry keeps the solution, curves of branch
// points take the place of those of folds [Yu. A. Kuznetsov, Elements of Applied Bifurcation Theory, 3rd ed.,
// Springer 2004, chapter 8].

#include <functional>

#include "arcslip/continuation/curves/curve.hpp"

namespace arcslip::continuation {

/// The other curve through a special point of a curve of folds or Hopf points, or of one of maps, of the same
/// base; no problem where there is none. A curve of Hopf points begins at a Bogdanov-Takens point: its part
/// with kappa < 0 is one of neutral saddles.
CurveStart curve_meeting(const ExtendedProblem& curve, const BranchPoint& point);

/// The same of special points of cycles and maps, by the problem on any base and the extras to begin with: of
/// folds and period doublings at fold-flip points, of either and Neimark-Sacker points at
/// `fold_neimark_sacker` and `resonance_1_1`, `flip_neimark_sacker` and `resonance_1_2`, of two pairs at
/// `double_neimark_sacker`. None elsewhere.
struct MultiplierCurve {
  std::function<std::unique_ptr<ExtendedProblem>(const Problem& base)> make;
  Vector extras;
};
std::optional<MultiplierCurve> multiplier_curve_meeting(const ExtendedProblem& curve, PointType type,
                                                        const BasePoint& at);

}  // namespace arcslip::continuation
