#include "arcslip/continuation/curves/meeting_curves.hpp"

#include <cmath>

#include "arcslip/continuation/cycles/doubling_problem.hpp"
#include "arcslip/continuation/cycles/torus_problem.hpp"
#include "arcslip/continuation/linear/borders.hpp"
#include "arcslip/continuation/points/branch_point_problem.hpp"
#include "arcslip/continuation/points/fold_problem.hpp"
#include "arcslip/continuation/points/hopf_problem.hpp"
#include "arcslip/continuation/points/normal_form.hpp"

namespace arcslip::continuation {

namespace {

/// Whether a point is a branch point that needs no perturbation, as a symmetry keeps them: along a curve of
/// these the equations of folds are singular.
bool is_kept_branch_point(const ExtendedProblem& curve, const BasePoint& at) {
  BranchPointProblem branch_points(curve.base(), curve.active());
  BasePoint start = at;
  start.extras = Vector::Zero(1);
  const auto located = locate(branch_points, start);
  constexpr double there = 1e-6;  // far above what points are located to
  const double parameter = at.parameters(curve.active());
  return located && std::abs(located->point.extras(0)) <= there &&
         std::abs(located->point.parameters(curve.active()) - parameter) <= there * (1 + std::abs(parameter));
}

template <class Special>
MultiplierCurve curve_of(Index active, const Vector& extras) {
  return {[active](const Problem& base) { return std::make_unique<Special>(base, active); }, extras};
}

}  // namespace

std::optional<MultiplierCurve> multiplier_curve_meeting(const ExtendedProblem& curve, PointType type,
                                                        const BasePoint& at) {
  const bool is_of_folds = dynamic_cast<const FoldProblem*>(&curve) != nullptr;
  const bool is_of_doublings = dynamic_cast<const DoublingProblem*>(&curve) != nullptr;
  const bool is_of_tori = dynamic_cast<const TorusProblem*>(&curve) != nullptr;
  const Index active = curve.active();
  const auto of_tori = [&](double kappa) {
    return curve_of<TorusProblem>(active, Vector::Constant(1, kappa));
  };
  if (!is_of_folds && !is_of_doublings && !is_of_tori) return std::nullopt;
  switch (type) {
    case PointType::fold_flip:
      return is_of_folds ? curve_of<DoublingProblem>(active, {}) : curve_of<FoldProblem>(active, {});
    case PointType::fold_neimark_sacker: {
      Vector kappa;
      const Guess there{at.unknowns, at.parameters, at.regime, {}};
      if (curve.base().special(PointType::neimark_sacker, active, there, kappa) == nullptr)
        return std::nullopt;
      return is_of_folds ? of_tori(kappa(0)) : curve_of<FoldProblem>(active, {});
    }
    case PointType::resonance_1_1: return is_of_tori ? curve_of<FoldProblem>(active, {}) : of_tori(1);
    case PointType::resonance_1_2: return is_of_tori ? curve_of<DoublingProblem>(active, {}) : of_tori(-1);
    default: return std::nullopt;
  }
}

CurveStart curve_meeting(const ExtendedProblem& curve, const BranchPoint& point) {
  const BasePoint at = curve.split(point.unknowns, point.parameters, point.regime);
  CurveStart start{nullptr, {at.unknowns, at.parameters, at.regime, {}}};
  if (curve.base().has_multipliers()) {
    if (const auto other = multiplier_curve_meeting(curve, point.type, at)) {
      start.problem = other->make(curve.base());
      start.point.extras = other->extras;
    }
    return start;
  }
  const bool is_of_hopf = dynamic_cast<const HopfProblem*>(&curve) != nullptr;
  const bool is_of_folds = dynamic_cast<const FoldProblem*>(&curve) != nullptr;
  const bool meets_folds = point.type == PointType::bogdanov_takens || point.type == PointType::zero_hopf;
  if (is_of_hopf && meets_folds) {
    if (is_kept_branch_point(curve, at)) {
      start.problem = std::make_unique<BranchPointProblem>(curve.base(), curve.active());
      start.point.extras = Vector::Zero(1);
    } else {
      start.problem = std::make_unique<FoldProblem>(curve.base(), curve.active());
    }
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
