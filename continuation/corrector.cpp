#include "arcslip/continuation/corrector.hpp"

#include <cmath>
#include <limits>

namespace arcslip::continuation {

Corrector::Corrector(const Problem& problem, Index parameter, const CorrectorOptions& options)
    : problem_(problem),
      size_(problem.size()),
      parameter_(parameter),
      options_(options),
      solver_(size_, 1),
      residual_(size_),
      jacobian_(size_, size_),
      parameter_jacobian_(size_, static_cast<Index>(problem.parameter_names().size())),
      correction_(size_ + 1),
      direction_(size_ + 1),
      unknown_scale_(size_),
      parameter_scale_(parameter_jacobian_.cols()),
      parameter_normal_(Vector::Unit(size_ + 1, size_)) {}

CurvePoint Corrector::make_point() const {
  CurvePoint point;
  point.unknowns = Vector::Zero(size_);
  point.parameters = Vector::Zero(parameter_jacobian_.cols());
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
  if (!problem_.evaluate(point.unknowns, point.parameters, point.regime,
                         {&residual_, &jacobian_, &parameter_jacobian_})) {
    return false;
  }
  point.residual = residual_.lpNorm<Eigen::Infinity>();
  return std::isfinite(point.residual);
}

bool Corrector::factor(const Vector& scale, const Vector& normal) {
  ++work_.factorizations;
  solver_.jacobian() = jacobian_ * scale.head(size_).asDiagonal();
  solver_.columns() = parameter_jacobian_.col(parameter_) * scale(size_);
  solver_.rows() = normal.head(size_).transpose();
  solver_.corner()(0, 0) = normal(size_);
  border_sign_ = solver_.factor();
  return border_sign_ != 0;
}

bool Corrector::solve_direction() {
  direction_.setZero();
  direction_(size_) = 1;
  solver_.solve(direction_);
  return direction_.allFinite();
}

double Corrector::rounding_level(const CurvePoint& point) const {
  double level = 0;
  for (Index i = 0; i < size_; ++i) {
    const double terms = jacobian_.row(i).cwiseAbs().dot(point.unknowns.cwiseAbs()) +
                         std::abs(parameter_jacobian_(i, parameter_) * point.parameters(parameter_));
    level = std::max(level, terms);
  }
  return 4 * std::numeric_limits<double>::epsilon() * (1 + level);
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
    correction_.head(size_) = -residual_;
    correction_(size_) = gap;
    solver_.solve(correction_);
    const double length = correction_.norm();
    if (!std::isfinite(length)) return Correction::singular;
    const bool telling = !held && last_residual > rounding_level(point);  // not a ratio of two roundings
    if (point.iterations == 1 && telling) contraction_ = length / last_length;
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
  correction_.head(size_) = -residual_;
  correction_(size_) = change;
  solver_.solve(correction_);
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
