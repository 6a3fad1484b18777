#include "arcslip/continuation/curves/response_extremum.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

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

void ResponseExtremum::start_at(const BasePoint& point) {
  origin_.unknowns = point.unknowns;
  origin_.parameters = point.parameters;
  origin_.regime = point.regime;
  corrector_.set_scale(origin_);
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

std::optional<bool> ResponseExtremum::is_peak(const BasePoint& at) {
  constexpr double nearest = 1e-11;
  constexpr double farthest = 1e-7;
  constexpr double growth = 4;
  start_at(at);
  if (!settle(farthest)) return std::nullopt;
  End low{};
  End high{};
  for (double way = nearest; way < farthest; way *= growth) {
    const End below{-way, slope(-way)};
    const End above{way, slope(way)};
    const bool turns =
        below.slope * above.slope < 0 && below.slope * low.slope > 0 && above.slope * high.slope > 0;
    const bool grows = std::abs(below.slope - above.slope) > 2 * std::abs(low.slope - high.slope);
    if (turns && grows) return below.slope > 0;
    low = below;
    high = above;
  }
  return std::nullopt;
}

/// Whether the slope jumps at its zero. On a side on which it does it is as large four times as near; one
/// that is smooth is half as large at most. The other side may have a smooth extremum nearer than that.
bool ResponseExtremum::is_corner(double way) {
  constexpr double beside = 1e-9;
  constexpr double like = 1.5;
  constexpr double alone = 100;  // times the slope of the other side
  const auto size = [&](double aside) { return std::abs(slope(way + aside * beside)); };
  const double before = size(-1);
  const double behind = size(1);
  const bool jumps_before = size(-4) < like * before;
  const bool jumps_behind = size(4) < like * behind;
  return (jumps_before && (jumps_behind || before > alone * behind)) ||
         (jumps_behind && behind > alone * before);
}

/// Where the slope jumps and keeps its sign: a place between in which it has the other one, if there is. On
/// one side of a jump it may go with the root of the way from there, and so through zero right beside it.
std::optional<ResponseExtremum::End> ResponseExtremum::beside_jump(End from, End to) {
  constexpr double leaps = 4;  // while the way grows by a half
  constexpr int halvings = 20;
  const double ratio = to.slope / from.slope;
  if (!(std::max(ratio, 1 / ratio) > leaps)) return std::nullopt;
  for (int i = 0; i < halvings; ++i) {
    const double way = 0.5 * (from.way + to.way);
    const End middle{way, slope(way)};
    if (middle.slope * from.slope < 0) return middle;
    if (std::isnan(middle.slope)) return std::nullopt;
    const bool is_before = std::abs(middle.slope - from.slope) < std::abs(middle.slope - to.slope);
    (is_before ? from : to) = middle;
  }
  return std::nullopt;
}

std::optional<ResponseExtremum::Found> ResponseExtremum::next_to(const BasePoint& guess, bool peak,
                                                                 double farthest) {
  constexpr double nearest = 1e-13;
  constexpr double growth = 1.5;
  start_at(guess);
  const std::optional<double> beside_guess = settle(farthest);
  if (!beside_guess) return std::nullopt;
  const double sign = peak ? 1 : -1;
  const auto found = [&](const End& low, const End& high) -> std::optional<Found> {
    if (!(sign * low.slope > 0 && sign * high.slope <= 0)) return std::nullopt;
    const double way =
        zero_between([&](double s) { return slope(s); }, low.way, high.way, low.slope, high.slope);
    if (!go(way)) return std::nullopt;
    const BasePoint at{at_.unknowns, at_.parameters, at_.regime, {}};
    return Found{at, *beside_guess + way, is_corner(way)};
  };
  End low{-nearest, slope(-nearest)};
  End high{nearest, slope(nearest)};
  if (const auto here = found(low, high)) return here;
  for (double way = growth * nearest; way < farthest; way *= growth) {
    const End below{-way, slope(-way)};
    const End above{way, slope(way)};
    const std::array pieces{std::pair{below, low}, std::pair{high, above}};
    for (const auto& [from, to] : pieces)
      if (const auto here = found(from, to)) return here;
    for (const auto& [from, to] : pieces) {
      const auto between = beside_jump(from, to);
      if (!between) continue;
      if (const auto here = found(from, *between)) return here;
      if (const auto here = found(*between, to)) return here;
    }
    low = below;
    high = above;
  }
  return std::nullopt;
}

}  // namespace arcslip::continuation
