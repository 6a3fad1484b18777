#include <algorithm>
#include <cmath>

#include "arcslip/continuation/path/corrector.hpp"
#include "arcslip/continuation/problem/evaluation.hpp"

// What spares factors on the way to a point of a sparse problem, where they take most of the time.

namespace arcslip::continuation {
namespace {

constexpr double shortness = 0.1;  // of a correction by factors from elsewhere, to the last one
constexpr double enough = 0.1;     // of the tolerance: what is left then

}  // namespace

bool Corrector::has_factors_at(const CurvePoint& origin, double near) {
  if (!has_direction_ || factored_unknowns_.size() == 0 || factored_regime_ != origin.regime) return false;
  before_ = (factored_unknowns_ - origin.unknowns).cwiseQuotient(origin.scale.head(size_));
  return before_.norm() < near;
}

std::optional<FactoredJacobian> Corrector::jacobian_at(const CurvePoint& point) {
  constexpr double most = 2;  // tolerances: `close` moves what has been corrected by one
  const bool is_last =
      factored_when_ == work_.evaluations && has_factors_at(point, most * options_.tolerance);
  if (!is_last) return std::nullopt;
  return FactoredJacobian{linearization_.sparse_jacobian(), solver_->rows_left(), &factored_scale_};
}

/// F alone, into `before_`: whether it has a value.
bool Corrector::find_residual(const CurvePoint& point) {
  return continuation::evaluate(problem_, point.unknowns, point.parameters, point.regime,
                                {.residual = &before_});
}

/// Corrects by factors from elsewhere, as `solve` does, as long as corrections shrink fast: from one of
/// length `last`, and at the rate `rate` to begin with, if that is known. How often.
template <class Solve>
int Corrector::shorten(CurvePoint& point, const CurvePoint& origin, double last, double rate,
                       const Solve& solve) {
  constexpr int most = 6;
  for (int i = 0; i < most; ++i) {
    if (options_.watch) options_.watch();
    if (!find_residual(point)) return i;
    const double length = solve();
    if (!(length < shortness * last)) return i;
    add_correction(point, origin);
    if (i > 0 || rate == 0) rate = length / last;
    if (rate * length <= enough * options_.tolerance) return i + 1;
    last = length;
  }
  return most;
}

/// By the factors at the origin, which are at hand, if corrections are so short that Newton's first one would
/// be its last, but not so short that it is anyway: the length of the last one, 0 where there was none.
double Corrector::approach(CurvePoint& point, const CurvePoint& origin, const Vector& normal,
                           double distance) {
  constexpr double near = 0.01;  // of the distance
  const bool helps = first_length_ < shortness * std::sqrt(options_.tolerance) && first_length_ > unseen();
  first_length_ = 0;
  if (!helps || !has_factors_at(origin, near * distance)) return 0;
  double length = 0;
  const auto solve = [&] {
    const double way = gap(point, origin, normal, distance);
    correction_ << -before_, 0;
    solver_->solve(correction_);
    correction_.array() *= factored_scale_.array() / origin.scale.array();
    const auto direction = direction_.cwiseProduct(factored_scale_).cwiseQuotient(origin.scale);
    // The factors' own condition is another one, by a multiple of the direction.
    correction_ += (way - normal.dot(correction_)) / normal.dot(direction) * direction;
    length = correction_.norm();
    if (first_length_ == 0) first_length_ = length;
    return length;
  };
  return shorten(point, origin, std::sqrt(options_.tolerance), nearing_, solve) > 0 ? length : 0;
}

/// How long a first correction may be to be the last one: where predictions are good, so short that the
/// tangent is not that of a prediction.
double Corrector::unseen() const { return (linearization_.sparse() ? 0.01 : 1) * options_.tolerance; }

/// How long Newton's first correction was, and what `approach` told.
void Corrector::remember(double length, double approached) {
  if (first_length_ == 0) first_length_ = length;
  nearing_ = approached > 0 ? std::min(shortness, length / approached) : shortness;
}

/// By the factors of Newton's correction, of length `last`, that led to the point, unless Newton's next one
/// is known to be short enough: whether it went on, with the contraction.
bool Corrector::go_on(CurvePoint& point, const CurvePoint& origin, const Vector& normal, double distance,
                      double last) {
  if (!linearization_.sparse() || last < shortness * std::sqrt(options_.tolerance)) return false;
  double first = 0;
  const auto solve = [&] {
    correction_(size_) = gap(point, origin, normal, distance);
    correction_.head(size_) = -before_;
    solver_->solve(correction_);
    const double length = correction_.norm();
    if (first == 0) first = length;
    return length;
  };
  if (shorten(point, origin, last, 0, solve) == 0) return false;
  if (point.iterations == 1) contraction_ = first / last;
  return true;
}

/// Makes the last correction without further factors: whether F is within the tolerance, or rounding, then.
bool Corrector::ends(CurvePoint& point, const CurvePoint& origin) {
  apply(point, origin);
  correction_.setZero();
  if (!find_residual(point)) return false;
  point.residual = before_.lpNorm<Eigen::Infinity>();
  return point.residual <= tolerance_ || (point.residual <= rounding_level(point) && !parameter_rounds_);
}

}  // namespace arcslip::continuation
