#include "arcslip/continuation/curves/meeting_curves.hpp"

#include <cmath>

#include "arcslip/continuation/linear/borders.hpp"
#include "arcslip/continuation/points/fold_problem.hpp"
#include "arcslip/continuation/points/hopf_problem.hpp"

namespace arcslip::continuation {

CurveStart curve_meeting(const ExtendedProblem& curve, const BranchPoint& point) {
  const BasePoint at = curve.split(point.unknowns, point.parameters, point.regime);
  CurveStart start{nullptr, {at.unknowns, at.parameters, at.regime, {}}};
  const bool is_of_hopf = dynamic_cast<const HopfProblem*>(&curve) != nullptr;
  const bool is_of_folds = dynamic_cast<const FoldProblem*>(&curve) != nullptr;
  const bool meets_folds = point.type == PointType::bogdanov_takens || point.type == PointType::zero_hopf;
  if (is_of_hopf && meets_folds) {
    start.problem = std::make_unique<FoldProblem>(curve.base(), curve.active());
    return start;
  }
  const bool meets_hopf = meets_folds ? is_of_folds : is_of_hopf && point.type == PointType::hopf_hopf;
  ComplexVector values;
  if (!meets_hopf || curve.base().sparse() ||
      !curve.base().eigenvalues(at.unknowns, at.parameters, at.regime, values))
    return start;
  double kappa = 0;
  if (point.type != PointType::bogdanov_takens) {
    if (is_of_hopf) {  // the pair of the curve itself is not meant
      const Complex own = std::sqrt(Complex(-at.extras(0)));
      remove_nearest(values, own);
      remove_nearest(values, -own);
    }
    kappa = kappa_of(values);
    if (!(kappa > 0)) return start;
  }
  start.problem = std::make_unique<HopfProblem>(curve.base(), curve.active());
  start.point.extras = Vector::Constant(1, kappa);
  return start;
}

}  // namespace arcslip::continuation
