// Solutions next to an interpolated branch.

#include "arcslip/continuation/path/interpolation.hpp"

namespace arcslip::continuation {

/// A sample as a point to correct.
CurvePoint InterpolatedBranch::origin(const Sample& sample) const {
  CurvePoint point = corrector_->make_point();
  point.unknowns = sample.unknowns;
  point.parameters = sample.parameters;
  point.regime = sample.regime;
  corrector_->set_scale(point);
  return point;
}

/// Makes a sample the solution next to it, across the direction `along`.
void InterpolatedBranch::solve(Sample& sample, const Vector& along) const {
  const CurvePoint origin = this->origin(sample);
  CurvePoint point = origin;
  const Vector normal = along.cwiseQuotient(origin.scale).normalized();
  if (corrector_->correct(point, origin, normal, 0, true) != Correction::converged) return;
  Vector away(normal.size());
  corrector_->difference(point, origin, away);
  constexpr double next_to = 100;  // times the estimated error: farther away lies another branch
  const double error = sample.error.cwiseQuotient(origin.scale).norm();
  if (!(away.norm() <= next_to * error + 1e-6)) return;
  sample.unknowns = point.unknowns;
  sample.parameters = point.parameters;
  sample.error.setZero();
}

/// What `by` corrects across the chord of a piece, unless it goes farther than the chord is long. What it
/// changes by less than the tolerance stays as it is: solutions are known no better.
template <class Correct>
std::optional<CurvePoint> InterpolatedBranch::correct(const CurvePoint& origin, std::size_t piece,
                                                      const Correct& by) const {
  const Vector chord = (position(piece + 1) - position(piece)).cwiseQuotient(origin.scale);
  CurvePoint point = origin;
  if (by(point, Vector(chord.normalized())) != Correction::converged) return std::nullopt;
  Vector away(chord.size());
  corrector_->difference(point, origin, away);
  if (!(away.norm() <= chord.norm())) return std::nullopt;
  const Index n = corrector_->size();
  const auto is_changed = away.head(n).array().abs() > corrector_->options().tolerance;
  point.unknowns = is_changed.select(point.unknowns, origin.unknowns);
  return point;
}

std::optional<Sample> InterpolatedBranch::corrected(std::size_t piece, double x) const {
  Sample sample = place(piece, x);
  const CurvePoint origin = this->origin(sample);
  const auto point = correct(origin, piece, [&](CurvePoint& at, const Vector& normal) {
    return corrector_->correct_once(at, origin, normal, 0);
  });
  if (!point) return std::nullopt;
  sample.unknowns = point->unknowns;
  sample.parameters = point->parameters;
  return sample;
}

std::optional<BranchPoint> InterpolatedBranch::solution(std::size_t piece, double x) const {
  const Sample sample = place(piece, x);
  const CurvePoint origin = this->origin(sample);
  auto at = correct(origin, piece, [&](CurvePoint& point, const Vector& normal) {
    return corrector_->correct(point, origin, normal, 0);
  });
  if (!at) return std::nullopt;
  corrector_->set_tangent(*at, origin);
  BranchPoint point;
  point.regime = sample.regime;
  point.unknowns = std::move(at->unknowns);
  point.parameters = std::move(at->parameters);
  point.iterations = at->iterations;
  point.residual = at->residual;
  point.tangent = at->tangent.cwiseProduct(at->scale);
  const auto away = [&](std::size_t other) {
    const BranchPoint& end = branch_.points[other];
    Vector z(end.unknowns.size() + 1);
    z << end.unknowns - point.unknowns, end.parameters(parameter_) - point.parameters(parameter_);
    return z.cwiseQuotient(origin.scale).norm();
  };
  const double part = away(piece) / (away(piece) + away(piece + 1));
  point.arclength = branch_.points[piece].arclength + part * distance(piece, piece + 1);
  return point;
}

}  // namespace arcslip::continuation
