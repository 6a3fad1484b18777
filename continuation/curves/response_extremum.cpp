#include "arcslip/continuation/curves/response_extremum.hpp"

#include <cmath>
#include <limits>

#include "arcslip/zero_between.hpp"

namespace arcslip::continuation {

ResponseExtremum::ResponseExtremum(const Problem& base, Index active, Index observable)
    : base_(base),
      active_(active),
      observable_(observable),
      corrector_(base, active, {}),
      origin_(corrector_.make_point()),
      at_(origin_) {
  gradient_ = {Vector::Zero(base.size()), Vector::Zero(at_.parameters.size())};
}

bool ResponseExtremum::begin(const BasePoint& point) {
  at_.unknowns = point.unknowns;
  at_.parameters = point.parameters;
  at_.regime = point.regime;
  corrector_.set_scale(at_);
  const Vector over_parameter = Vector::Unit(base_.size() + 1, base_.size());
  if (corrector_.linearise(at_, over_parameter) != Correction::converged) return false;
  forward_ = corrector_.direction().normalized();
  return true;
}

/// Along the branch from the origin.
bool ResponseExtremum::go(double way) {
  corrector_.displace(origin_, way * forward_, at_);
  at_.regime = origin_.regime;
  return corrector_.correct(at_, origin_, forward_, way, true) == Correction::converged;
}

double ResponseExtremum::slope(double way) {
  if (!go(way)) return std::numeric_limits<double>::quiet_NaN();
  const Vector tangent = corrector_.direction();  // forward . tangent = 1
  const double value = base_.observe(at_.unknowns, at_.parameters, at_.regime, observable_, gradient_);
  return rate(gradient_, active_, origin_.scale, tangent) / std::abs(value);
}

/// Takes a point of the branch as the origin: that next to the guess or, as Newton's method may go back and
/// forth across a corner, one a little beside it. Returns how far.
std::optional<double> ResponseExtremum::settle(double farthest) {
  constexpr double nearest = 1e-9;
  constexpr double growth = 4;
  for (double beside = 0; beside < farthest; beside = beside == 0 ? nearest : growth * beside) {
    for (const double way : {beside, -beside}) {
      if (!go(way)) continue;
      const CurvePoint solved = at_;
      origin_ = solved;
      return way;
    }
  }
  return std::nullopt;
}

std::optional<ResponseExtremum::Found> ResponseExtremum::next_to(const BasePoint& guess, bool peak,
                                                                 double farthest) {
  constexpr double nearest = 1e-13;
  constexpr double growth = 1.5;
  origin_.unknowns = guess.unknowns;
  origin_.parameters = guess.parameters;
  origin_.regime = guess.regime;
  corrector_.set_scale(origin_);
  const std::optional<double> beside_guess = settle(farthest);
  if (!beside_guess) return std::nullopt;
  const double sign = peak ? 1 : -1;
  struct End {
    double way;
    double slope;
  };
  const auto found = [&](const End& low, const End& high) -> std::optional<Found> {
    if (!(sign * low.slope > 0 && sign * high.slope <= 0)) return std::nullopt;
    const double way =
        zero_between([&](double s) { return slope(s); }, low.way, high.way, low.slope, high.slope);
    if (!go(way)) return std::nullopt;
    const BasePoint at{at_.unknowns, at_.parameters, at_.regime, {}};
    // A slope that is as large four times as near jumps; a smooth one is half as large at most.
    constexpr double beside = 1e-9;
    constexpr double like = 1.5;
    const auto jumps = [&](double side) {
      return std::abs(slope(way + 4 * side * beside)) < like * std::abs(slope(way + side * beside));
    };
    return Found{at, *beside_guess + way, jumps(-1) && jumps(1)};
  };
  End low{-nearest, slope(-nearest)};
  End high{nearest, slope(nearest)};
  if (const auto here = found(low, high)) return here;
  for (double way = growth * nearest; way < farthest; way *= growth) {
    const End below{-way, slope(-way)};
    const End above{way, slope(way)};
    if (const auto here = found(below, low)) return here;
    if (const auto here = found(high, above)) return here;
    low = below;
    high = above;
  }
  return std::nullopt;
}

}  // namespace arcslip::continuation
