#include "arcslip/continuation/path/one_curve.hpp"

#include <algorithm>
#include <cmath>

namespace arcslip::continuation {

OneCurve::OneCurve(Corrector& corrector, Prober& prober, Step& step)
    : corrector_(corrector), prober_(prober), step_(step) {
  const Vector zero = Vector::Zero(corrector.size() + 1);
  begin_ = end_ = {0, zero, zero, 1};
  middle_.fill(begin_);
}

bool OneCurve::joins(const Vector& foretold) {
  constexpr double far = 3;           // times the step before, by which the determinant tells nothing
  constexpr double unforeseen = 0.3;  // of the bend
  constexpr double nothing = 1e-3;    // of the determinant, where slopes are not well known
  if (step_.past.empty() || !std::isfinite(step_.here.log_determinant)) return true;
  const PastPoint& past = step_.past.front();
  const double before = past.sign * step_.here.orientation * std::exp(past.log - step_.here.log_determinant);
  const double rate = (1 - before) / past.behind;
  if (!(rate < 0) || step_.chord.norm() > far * past.behind) return true;
  begin_.slope = step_.slope_from;
  end_.s = step_.distance;
  end_.way = step_.chord;
  end_.slope = step_.slope_to;
  const CurvePoint& there = step_.there;
  end_.determinant = determinant(there.orientation, there.log_determinant);
  const bool is_elsewhere = (step_.chord - foretold).norm() > unforeseen * bend(begin_, end_);
  if (std::abs(end_.determinant) < nothing || !(is_elsewhere || is_uneven(begin_, end_))) return true;
  // What follows begins with the same factors as if it had not been looked at.
  return joins(begin_, end_, rate, 0) &&
         corrector_.linearise(step_.there, step_.normal) == Correction::converged;
}

/// The same of a part of the step, where the determinant begins to change at this rate. Of a curve the halves
/// are more even than the whole, and the determinant vanishes where it was to, or keeps away in time.
bool OneCurve::joins(const Place& from, const Place& to, double rate, std::size_t halvings) {
  constexpr double well = 0.25;  // of the determinant: by as much beyond zero
  const double way = (to.way - from.way).norm();
  const bool was_to_vanish = to.determinant > 0 && from.determinant + rate * way < -well * from.determinant;
  const bool uneven = is_uneven(from, to);
  if (!uneven && !was_to_vanish) return true;
  if ((uneven && halvings > 0) || halvings == most_halvings) return false;
  Place& middle = middle_[halvings];
  middle.s = 0.5 * (from.s + to.s);
  if (!prober_.probe(middle.s)) return false;
  corrector_.difference(prober_.probed().point, step_.here, middle.way);
  middle.slope = prober_.probed().slope;
  middle.determinant =
      determinant(corrector_.orientation(), corrector_.log_determinant() + std::log(middle.slope.norm()));
  if (!uneven && is_foretold(from, middle, to)) return true;
  return joins(from, middle, rate, halvings + 1) &&
         joins(middle, to, (middle.determinant - from.determinant) / (middle.way - from.way).norm(),
               halvings + 1);
}

double OneCurve::determinant(double sign, double log) const {
  return sign * step_.here.orientation * std::exp(log - step_.here.log_determinant);
}

/// How far the way between two places is from being straight.
double OneCurve::bend(const Place& from, const Place& to) const {
  constexpr double negligible = 0.02;  // of the whole step
  const double h = to.s - from.s;
  return std::max({(to.way - from.way - h * from.slope).norm(), (to.way - from.way - h * to.slope).norm(),
                   h * (to.slope - from.slope).norm(), negligible * step_.chord.norm()});
}

/// Whether the slopes at both ends do not tell the way between them.
bool OneCurve::is_uneven(const Place& from, const Place& to) const {
  constexpr double much = 0.2;  // of the bend
  const double half = 0.5 * (to.s - from.s);
  return (to.way - from.way - half * (from.slope + to.slope)).norm() > much * bend(from, to);
}

/// Whether the middle lies on the cubic between both ends.
bool OneCurve::is_foretold(const Place& from, const Place& middle, const Place& to) const {
  constexpr double hardly = 0.01;  // of the bend
  const double eighth = 0.125 * (to.s - from.s);
  return (middle.way - 0.5 * (from.way + to.way) - eighth * (from.slope - to.slope)).norm() <
         hardly * bend(from, to);
}

}  // namespace arcslip::continuation
