#include "arcslip/continuation/curves/meeting_curves.hpp"

#include <cmath>

#include "arcslip/continuation/cycles/doubling_problem.hpp"
#include "arcslip/continuation/cycles/torus_problem.hpp"
#include "arcslip/continuation/path/newton.hpp"
#include "arcslip/continuation/points/branch_point_problem.hpp"
#include "arcslip/continuation/points/fold_problem.hpp"
#include "arcslip/continuation/points/hopf_problem.hpp"
#include "arcslip/continuation/points/normal_form.hpp"

namespace arcslip::continuation {

namespace {

/// Whether a point is a branch point that needs no perturbation, as a symmetry keeps them: along a curve of
/// these the equations of folds are singular. Where its parameter stands still it is not located anew.
bool is_kept_branch_point(const ExtendedProblem& curve, const BasePoint& at) {
  BranchPointProblem branch_points(curve.base(), curve.active());
  BasePoint start = at;
  start.extras = Vector::Zero(1);
  if (branch_points.settle(start)) {
    Guess guess{{}, {}, at.regime, {}};
    branch_points.join(start, guess.unknowns, guess.parameters);
    if (nearly_solves(branch_points, guess)) return true;
  }
  const auto located = locate(branch_points, start);
  constexpr double there = 1e-6;  // far above what points are located to
  const double parameter = at.parameters(curve.active());
  return located && std::abs(located->point.extras(0)) <= there &&
         std::abs(located->point.parameters(curve.active()) - parameter) <= there * (1 + std::abs(parameter));
}

/// The angle of the pair of multipliers nearest to the unit circle but for the curve's own; 0 without one.
double other_angle(const ExtendedProblem& curve, const BasePoint& at) {
  const auto* orbits = dynamic_cast<const PeriodicOrbit*>(&curve.base());
  if (orbits == nullptr ? curve.base().sparse() : orbits->is_trigonometric()) return 0;
  Vector unknowns;
  Vector parameters;
  curve.join(at, unknowns, parameters);
  ComplexVector values;
  if (!curve.eigenvalues(unknowns, parameters, at.regime, values)) return 0;
  return std::sqrt(kappa_of(values)) * (orbits == nullptr ? 1 : orbits->period(at.unknowns, at.parameters));
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
  const auto of_other_pair = [&]() -> std::optional<MultiplierCurve> {
    const double angle = other_angle(curve, at);
    if (!(angle > 0)) return std::nullopt;
    return of_tori(std::cos(angle));
  };
  if (!is_of_folds && !is_of_doublings && !is_of_tori) return std::nullopt;
  switch (type) {
    case PointType::fold_flip:
      return is_of_folds ? curve_of<DoublingProblem>(active, {}) : curve_of<FoldProblem>(active, {});
    case PointType::fold_neimark_sacker:
      return is_of_folds ? of_other_pair() : curve_of<FoldProblem>(active, {});
    case PointType::flip_neimark_sacker:
      return is_of_doublings ? of_other_pair() : curve_of<DoublingProblem>(active, {});
    case PointType::double_neimark_sacker: return of_other_pair();
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
  if (!meets_hopf || curve.base().sparse()) return start;
  double kappa = 0;
  if (point.type != PointType::bogdanov_takens) {
    ComplexVector values;
    if (curve.eigenvalues(point.unknowns, point.parameters, point.regime, values)) kappa = kappa_of(values);
    if (!(kappa > 0)) return start;
  }
  start.problem = std::make_unique<HopfProblem>(curve.base(), curve.active());
  start.point.extras = Vector::Constant(1, kappa);
  return start;
}

}  // namespace arcslip::continuation
