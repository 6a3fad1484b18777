// Branch points within a step: there the bordered Jacobian's determinant changes its sign.

#include <cmath>

#include "arcslip/continuation/normal_form.hpp"
#include "arcslip/continuation/stepper.hpp"

namespace arcslip::continuation {

/// Narrows the step down by the sign of the determinant until Newton's method finds the branch point from
/// there. A step that has jumped to another piece has none.
bool Stepper::find_crossing() {
  double low = 0;
  double high = distance_;
  for (int i = 0; i < 6; ++i) {
    const double middle = 0.5 * (low + high);
    if (locate_crossing(middle)) return true;
    if (!probe(middle)) return false;
    corrector_.set_tangent(probe_, here_);
    (probe_.orientation == here_.orientation ? low : high) = middle;
  }
  return false;
}

bool Stepper::locate_crossing(double s) {
  const Index n = corrector_.size();
  const Index parameter = corrector_.parameter();
  Crossing crossing{0, here_};
  interpolate(s, work_);
  corrector_.displace(here_, work_, crossing.point);
  BranchPointProblem problem(problem_, parameter);
  const auto located =
      locate(problem, {crossing.point.unknowns, crossing.point.parameters, here_.regime, Vector::Zero(1)},
             corrector_.tolerance());
  if (!located) return false;
  crossing.point.unknowns = located->point.unknowns;
  crossing.point.parameters = located->point.parameters;
  crossing.point.iterations = located->iterations;
  corrector_.difference(crossing.point, here_, predicted_);
  crossing.s = normal_.dot(predicted_);
  if (!(crossing.s > 0) || !(crossing.s < distance_)) return false;
  interpolate(crossing.s, work_);
  if (!((work_ - predicted_).norm() < 0.05 * step_.norm())) return false;  // a point of another branch
  corrector_.linearise(crossing.point, normal_);
  if (!(crossing.point.residual <= 10 * corrector_.tolerance())) return false;  // of a perturbed problem only

  // Of the two branches through the point the one that goes on as this one does.
  const Guess at{crossing.point.unknowns, crossing.point.parameters, here_.regime, {}};
  const auto form = branch_point_form(problem_, parameter, at);
  corrector_.set_scale(crossing.point);
  work_ = slope_from_ + (crossing.s / distance_) * (slope_to_ - slope_from_);
  work_.array() *= here_.scale.array() / crossing.point.scale.array();
  work_.normalize();
  crossing.point.tangent = work_;
  double best = 0.9;
  for (Index i = 0; form && i < 2; ++i) {
    const Vector& direction = form->directions[static_cast<std::size_t>(i)];
    if (direction.size() != n + 1) continue;
    Vector scaled = direction.cwiseQuotient(crossing.point.scale).normalized();
    const double along = scaled.dot(work_);
    if (std::abs(along) < best) continue;
    best = std::abs(along);
    crossing.point.tangent = std::copysign(1.0, along) * scaled;
  }
  crossing.point.orientation = there_.orientation;
  crossing_ = std::move(crossing);
  return true;
}

void Stepper::cut_at_crossing() {
  std::swap(there_, crossing_->point);
  distance_ = crossing_->s;
  corrector_.difference(there_, here_, step_);
  slope_to_ = there_.tangent.array() * there_.scale.array() / here_.scale.array();
  slope_to_ /= normal_.dot(slope_to_);
  monitor(there_, here_.scale, slope_to_, to_);
}

std::optional<double> Stepper::passes(const CurvePoint& past) {
  if (past.regime != here_.regime) return std::nullopt;
  if (crossing_) {  // no probe finds a start that is the branch point itself
    corrector_.difference(past, crossing_->point, predicted_);
    if (predicted_.norm() < 1e-7 && crossing_->point.tangent.dot(past.tangent) > 0) return crossing_->s;
  }
  const double length = step_.norm();
  const Index parameter = corrector_.parameter();
  const double aside = past.parameters(parameter) - here_.parameters(parameter);
  if (!(std::abs(aside) < 2 * length * here_.scale(corrector_.size()))) return std::nullopt;  // most often
  corrector_.difference(past, here_, predicted_);
  const double s = normal_.dot(predicted_);
  if (!(predicted_.norm() < 2 * length) || !(s > 0) || !(s <= distance_)) return std::nullopt;
  interpolate(s, work_);
  if (!((work_ - predicted_).norm() < 0.05 * length) || !probe(s)) return std::nullopt;
  corrector_.difference(past, probe_, predicted_);
  work_ = probe_slope_.cwiseProduct(here_.scale).cwiseQuotient(past.scale);
  const bool same_way = work_.dot(past.tangent) > 0;
  if (!(predicted_.norm() < 1e-7) || !same_way) return std::nullopt;
  return s;
}

}  // namespace arcslip::continuation
