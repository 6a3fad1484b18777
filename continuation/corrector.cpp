#include "arcslip/continuation/corrector.hpp"

#include <cmath>
#include <limits>

namespace arcslip::continuation {

Work operator+(const Work& a, const Work& b) {
  return {a.evaluations + b.evaluations, a.factorizations + b.factorizations, a.iterations + b.iterations,
          a.rejected_steps + b.rejected_steps};
}

Corrector::Corrector(const Problem& problem, Index parameter, const CorrectorOptions& options)
    : problem_(problem),
      size_(problem.size()),
      parameter_(parameter),
      options_(options),
      linearization_(problem),
      solver_(make_bordered_solver(size_, 1, problem.sparse())),
      correction_(size_ + 1),
      direction_(size_ + 1),
      unknown_scale_(size_),
      magnitudes_(size_),
      parameter_scale_(linearization_.parameter_jacobian().cols()),
      parameter_normal_(Vector::Unit(size_ + 1, size_)) {}

CurvePoint Corrector::make_point() const {
  CurvePoint point;
  point.unknowns = Vector::Zero(size_);
  point.parameters = Vector::Zero(parameter_scale_.size());
  point.scale = Vector::Ones(size_ + 1);
  point.tangent = Vector::Zero(size_ + 1);
  return point;
}

void Corrector::set_scale(CurvePoint& point) {
  problem_.scale(point.unknowns, point.parameters, unknown_scale_, parameter_scale_);
  point.scale.head(size_) = unknown_scale_ * std::sqrt(static_cast<double>(size_));
  point.scale(size_) = parameter_scale_(parameter_);
}

void Corrector::difference(const CurvePoint& point, const CurvePoint& origin, Vector& out) const {
  out.head(size_) = (point.unknowns - origin.unknowns).cwiseQuotient(origin.scale.head(size_));
  out(size_) = (point.parameters(parameter_) - origin.parameters(parameter_)) / origin.scale(size_);
}

void Corrector::displace(const CurvePoint& origin, const Vector& displacement, CurvePoint& point) const {
  point.unknowns = origin.unknowns + origin.scale.head(size_).cwiseProduct(displacement.head(size_));
  point.parameters = origin.parameters;
  point.parameters(parameter_) += origin.scale(size_) * displacement(size_);
  point.regime = origin.regime;
}

bool Corrector::evaluate(CurvePoint& point) {
  ++work_.evaluations;
  if (!linearization_.evaluate(point.unknowns, point.parameters, point.regime)) return false;
  point.residual = linearization_.residual().lpNorm<Eigen::Infinity>();
  return true;
}

bool Corrector::factor(const Vector& scale, const Vector& normal) {
  ++work_.factorizations;
  linearization_.fill(*solver_, scale);
  solver_->columns() = linearization_.parameter_jacobian().col(parameter_) * scale(size_);
  solver_->rows() = normal.head(size_).transpose();
  solver_->corner()(0, 0) = normal(size_);
  border_sign_ = solver_->factor();
  return border_sign_ != 0;
}

bool Corrector::solve_direction() {
  direction_.setZero();
  direction_(size_) = 1;
  solver_->solve(direction_);
  return direction_.allFinite();
}

double Corrector::rounding_level(const CurvePoint& point) {
  linearization_.multiply_absolute(point.unknowns, magnitudes_);
  magnitudes_ +=
      (linearization_.parameter_jacobian().col(parameter_) * point.parameters(parameter_)).cwiseAbs();
  return 4 * std::numeric_limits<double>::epsilon() * (1 + magnitudes_.maxCoeff());
}

Correction Corrector::correct(CurvePoint& point, const CurvePoint& origin, const Vector& normal,
                              double distance, bool to_rounding) {
  contraction_ = 0;
  point.iterations = 0;
  bool held = false;
  double last_length = 0;
  double last_residual = std::numeric_limits<double>::infinity();
  while (true) {
    if (!evaluate(point)) return Correction::cannot_evaluate;
    if (!factor(origin.scale, normal)) return Correction::singular;
    const bool last = point.iterations >= options_.max_iterations;
    const bool good = point.residual <= options_.tolerance;
    const bool stagnant = point.residual >= 0.5 * last_residual;
    const bool rounded = stagnant && point.residual <= rounding_level(point);
    if (point.residual == 0 || (good && (!to_rounding || stagnant || last)) || (rounded && held)) {
      return solve_direction() ? Correction::converged : Correction::singular;
    }
    if (last) return Correction::too_many_iterations;
    held = held || rounded;  // the parameter's own rounding is what is left: keep it and correct the unknowns
    if (held && !factor(origin.scale, parameter_normal_)) return Correction::singular;
    difference(point, origin, correction_);
    const double gap = held ? 0 : distance - normal.dot(correction_);
    correction_.head(size_) = -linearization_.residual();
    correction_(size_) = gap;
    solver_->solve(correction_);
    const double length = correction_.norm();
    if (!std::isfinite(length)) return Correction::singular;
    // A ratio of two roundings does not count, unless it is too small to shorten a step.
    const auto counts = [&](double ratio) { return ratio < 0.01 || last_residual > rounding_level(point); };
    if (point.iterations == 1 && !held && counts(length / last_length)) contraction_ = length / last_length;
    if (point.iterations >= 1 && length > 0.7 * last_length && !good && !rounded)
      return Correction::diverging;
    last_length = length;
    last_residual = point.residual;
    apply(point, origin);
  }
}

Correction Corrector::correct_once(CurvePoint& point, const CurvePoint& origin, const Vector& normal,
                                   double change) {
  if (!evaluate(point)) return Correction::cannot_evaluate;
  if (!factor(origin.scale, normal)) return Correction::singular;
  correction_.head(size_) = -linearization_.residual();
  correction_(size_) = change;
  solver_->solve(correction_);
  if (!correction_.allFinite()) return Correction::singular;
  apply(point, origin);
  return Correction::converged;
}

void Corrector::apply(CurvePoint& point, const CurvePoint& origin) {
  point.unknowns += origin.scale.head(size_).cwiseProduct(correction_.head(size_));
  point.parameters(parameter_) += origin.scale(size_) * correction_(size_);
  ++point.iterations;
  ++work_.iterations;
}

Correction Corrector::linearise(CurvePoint& point, const Vector& normal) {
  if (!evaluate(point)) return Correction::cannot_evaluate;
  if (!factor(point.scale, normal) || !solve_direction()) return Correction::singular;
  return Correction::converged;
}

bool Corrector::nearly_singular() {
  // A solution with a right-hand side of unit length and no preference is as long as the inverse is large.
  correction_.setConstant(1 / std::sqrt(static_cast<double>(size_ + 1)));
  for (Index i = 0; i <= size_; i += 2) correction_(i) *= 0.7;
  solver_->solve(correction_);
  linearization_.multiply_absolute(Vector::Ones(size_), magnitudes_);
  return !(correction_.norm() * magnitudes_.maxCoeff() < 1e11);
}

void Corrector::set_tangent(CurvePoint& point, const CurvePoint& origin) {
  const double parameter_scale = origin.scale(size_);  // origin and point may be the same
  set_scale(point);
  point.tangent = direction_;
  if (&point != &origin) {
    point.tangent.head(size_).array() *= origin.scale.head(size_).array() / point.scale.head(size_).array();
    point.tangent(size_) *= parameter_scale / point.scale(size_);
  }
  point.tangent.normalize();
  point.orientation = border_sign_;
}

}  // namespace arcslip::continuation
