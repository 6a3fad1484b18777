#include "arcslip/continuation/path/corrector.hpp"

#include <cmath>
#include <limits>

#include "arcslip/continuation/linear/front_plan.hpp"

namespace arcslip::continuation {

Work operator+(const Work& a, const Work& b) {
  return {a.evaluations + b.evaluations, a.factorizations + b.factorizations, a.iterations + b.iterations,
          a.rejected_steps + b.rejected_steps, a.spectra + b.spectra};
}

Corrector::Corrector(const Problem& problem, Index parameter, const CorrectorOptions& options)
    : problem_(problem),
      size_(problem.size()),
      parameter_(parameter),
      options_(options),
      tolerance_(options.tolerance),
      linearization_(problem),
      told_(problem.determinants()),
      solver_(linearization_.make_solver(1)),
      correction_(size_ + 1),
      direction_(size_ + 1),
      unknown_scale_(size_),
      magnitudes_(size_),
      parameter_scale_(linearization_.parameter_jacobian().cols()),
      before_(size_),
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
  double size = std::sqrt(static_cast<double>(size_));
  if (is_over_parameter(point.regime)) size *= not_counted;
  point.scale.head(size_) = unknown_scale_ * size;
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

bool Corrector::calibrate(CurvePoint& point) {
  constexpr double large = 1e3;  // where 1 is large for F
  if (!evaluate(point)) return false;
  problem_.scale(point.unknowns, point.parameters, unknown_scale_, parameter_scale_);
  linearization_.multiply_absolute(unknown_scale_, magnitudes_);
  const double size = magnitudes_.maxCoeff();
  set_residual_size(size > large ? size : 1);
  return true;
}

void Corrector::set_residual_size(double size) {
  residual_size_ = size;
  tolerance_ = options_.tolerance * size;
}

bool Corrector::evaluate(CurvePoint& point) {
  if (options_.watch) options_.watch();
  ++work_.evaluations;
  if (!linearization_.evaluate(point.unknowns, point.parameters, point.regime)) return false;
  point.residual = linearization_.residual().lpNorm<Eigen::Infinity>();
  return true;
}

bool Corrector::factor(const CurvePoint& point, const Vector& scale, const Vector& normal) {
  ++work_.factorizations;
  has_direction_ = false;
  factored_scale_ = scale;
  if (linearization_.sparse()) {
    factored_unknowns_ = point.unknowns;
    factored_regime_ = point.regime;
    factored_when_ = work_.evaluations;
  }
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
  has_direction_ = direction_.allFinite();
  return has_direction_;
}

double Corrector::rounding_level(const CurvePoint& point) {
  constexpr double epsilon = std::numeric_limits<double>::epsilon();
  linearization_.multiply_absolute(point.unknowns, magnitudes_);
  const double of_unknowns = magnitudes_.maxCoeff();
  magnitudes_ +=
      (linearization_.parameter_jacobian().col(parameter_) * point.parameters(parameter_)).cwiseAbs();
  const double all = magnitudes_.maxCoeff();
  parameter_rounds_ = all > 10 * (1 + of_unknowns);
  return 4 * epsilon * (1 + all);
}

/// The correction that changes the condition by `change`, and its length.
double Corrector::solve_correction(double change) {
  correction_.head(size_) = -linearization_.residual();
  correction_(size_) = change;
  solver_->solve(correction_);
  return correction_.norm();
}

Correction Corrector::with_direction() {
  return solve_direction() ? Correction::converged : Correction::singular;
}

/// What is left of the distance, over `correction_`.
double Corrector::gap(const CurvePoint& point, const CurvePoint& origin, const Vector& normal,
                      double distance) {
  difference(point, origin, correction_);
  return distance - normal.dot(correction_);
}

Correction Corrector::correct(CurvePoint& point, const CurvePoint& origin, const Vector& normal,
                              double distance, bool to_rounding) {
  contraction_ = 0;
  point.iterations = 0;
  bool held = false;
  bool went_on = false;
  bool ended = false;
  double last_length = 0;
  double last_residual = std::numeric_limits<double>::infinity();
  const double approached = approach(point, origin, normal, to_rounding ? 0 : distance);
  while (true) {
    if (!evaluate(point)) return Correction::cannot_evaluate;
    if (!factor(point, origin.scale, normal)) return Correction::singular;
    const bool last = point.iterations >= options_.max_iterations;
    const bool stagnant = point.residual >= 0.5 * last_residual;
    double length = solve_correction(held ? 0 : gap(point, origin, normal, distance));
    if (point.iterations == 0) remember(length, approached);
    // The correction that is left, too, since the residual is in units of the problem's.
    const double most = point.iterations > 0 || approached > 0 ? options_.tolerance : unseen();
    const bool good = point.residual <= tolerance_ && (stagnant || length <= most);
    // Of a sparse problem the value of F takes much less than factors.
    const bool may_end = !good && !ended && !held && !last && !to_rounding && linearization_.sparse();
    if (may_end && length <= most) {
      ended = true;
      last_length = length;
      last_residual = point.residual;
      if (ends(point, origin)) return with_direction();
      continue;
    }
    const bool rounded = !good && (stagnant || (!to_rounding && length <= options_.tolerance)) &&
                         point.residual <= rounding_level(point);
    if (point.residual == 0 || (good && (!to_rounding || stagnant || last)) ||
        (rounded && (held || !parameter_rounds_)))
      return with_direction();
    if (last) return Correction::too_many_iterations;
    held = held || rounded;  // keep the parameter, whose rounding is what is left, and correct the unknowns
    if (held) {
      if (!factor(point, origin.scale, parameter_normal_)) return Correction::singular;
      length = solve_correction(0);
    }
    if (!std::isfinite(length)) return Correction::singular;
    // A ratio to or of what rounding leaves does not count, unless it is too small to shorten a step.
    const auto counts = [&](double ratio) {
      return ratio < 0.01 || std::min(last_residual, point.residual) > rounding_level(point);
    };
    if (point.iterations == 1 && !held && !went_on && counts(length / last_length))
      contraction_ = length / last_length;
    // A guess may be two corrections of one length off, as a small cycle at a double Hopf point is.
    const bool comes_nearer = distance == 0 && point.iterations == 1 && length < 1.1 * last_length &&
                              point.residual < 0.1 * last_residual;
    if (point.iterations >= 1 && length > 0.7 * last_length && !good && !rounded && !comes_nearer &&
        point.residual > rounding_level(point)) {
      return Correction::diverging;
    }
    last_length = length;
    last_residual = point.residual;
    apply(point, origin);
    went_on = !held && go_on(point, origin, normal, distance, length);
  }
}

/// Makes the correction the one that keeps the parameter, which differs by a multiple of the direction, and
/// returns its length.
double Corrector::turn_to_parameter() {
  if (direction_(size_) == 0) return std::numeric_limits<double>::infinity();
  correction_ -= correction_(size_) / direction_(size_) * direction_;
  correction_(size_) = 0;
  return correction_.norm();
}

void Corrector::close(CurvePoint& point, const CurvePoint& origin, const Vector& normal, double near) {
  constexpr int most = 5;          // corrections, of which each is to be much shorter than the last
  constexpr double shrinks = 0.2;  // beside a fold they halve at best
  const auto solve = [&] {
    const bool solved = evaluate(point) && factor(point, origin.scale, normal) && solve_direction() &&
                        std::isfinite(solve_correction(0));
    return solved ? turn_to_parameter() : std::numeric_limits<double>::infinity();
  };
  const double first = turn_to_parameter();
  if (!(first < near)) return;
  if (first <= options_.tolerance) return apply(point, origin);
  before_ = point.unknowns;
  double length = first;
  for (int i = 0; i < most && length > options_.tolerance; ++i) {
    const double last = length;
    apply(point, origin);
    length = solve();
    if (!(length < shrinks * last)) break;
  }
  if (length <= shrinks * first && point.residual <= tolerance_) return;
  point.unknowns = before_;
  solve();
}

Correction Corrector::correct_once(CurvePoint& point, const CurvePoint& origin, const Vector& normal,
                                   double change) {
  if (!evaluate(point)) return Correction::cannot_evaluate;
  if (!factor(point, origin.scale, normal)) return Correction::singular;
  if (!std::isfinite(solve_correction(change))) return Correction::singular;
  apply(point, origin);
  return Correction::converged;
}

void Corrector::add_correction(CurvePoint& point, const CurvePoint& origin) const {
  point.unknowns += origin.scale.head(size_).cwiseProduct(correction_.head(size_));
  point.parameters(parameter_) += origin.scale(size_) * correction_(size_);
}

void Corrector::apply(CurvePoint& point, const CurvePoint& origin) {
  add_correction(point, origin);
  ++point.iterations;
  ++work_.iterations;
}

Correction Corrector::linearise(CurvePoint& point, const Vector& normal) {
  if (!evaluate(point)) return Correction::cannot_evaluate;
  if (!factor(point, point.scale, normal)) return Correction::singular;
  return with_direction();
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
  const double length = point.tangent.norm();
  point.tangent /= length;
  point.orientation = border_sign_;
  LogProduct size = determinant(point.scale);
  size *= length;
  point.log_determinant = size.log();
}

double Corrector::log_determinant() const {
  if (border_sign_ == 0) return -std::numeric_limits<double>::infinity();
  return determinant(factored_scale_).log();
}

/// Of the matrix in a scale, the lengths of all but nearly full rows taken out if they are to be.
LogProduct Corrector::determinant(const Vector& scale) const {
  LogProduct size;
  solver_->multiply_determinant(size);
  const bool own = told_ == Determinants::in_own_units;
  for (Index i = 0; i <= size_; ++i) size *= (own ? 1 : scale(i)) / factored_scale_(i);
  if (told_ != Determinants::over_rows) return size;
  const SparseMatrix& jacobian = linearization_.sparse_jacobian();
  squares_ = (linearization_.parameter_jacobian().col(parameter_) * scale(size_)).cwiseAbs2();
  counts_.setZero(size_);
  for (Index column = 0; column < size_; ++column) {
    for (SparseMatrix::InnerIterator entry(jacobian, column); entry; ++entry) {
      const double value = entry.value() * scale(column);
      squares_(entry.row()) += value * value;
      ++counts_(entry.row());
    }
  }
  const Index most = most_of_a_row(jacobian);
  for (Index row = 0; row < size_; ++row) {
    if (counts_(row) <= most) size /= std::sqrt(squares_(row));
  }
  return size;
}

}  // namespace arcslip::continuation
