#include "arcslip/continuation/curves/corner_slopes.hpp"

#include <algorithm>
#include <boost/math/tools/minima.hpp>
#include <cmath>
#include <limits>

#include "arcslip/zero_between.hpp"

namespace arcslip::continuation {

std::optional<NearestBorder> nearest_border(const Problem& base, Index active, const BasePoint& point,
                                            const Regime& regime, int except) {
  Vector unknowns(base.size());
  Vector parameters(point.parameters.size());
  base.scale(point.unknowns, point.parameters, unknowns, parameters);
  Gradient gradient{Vector::Zero(base.size()), Vector::Zero(point.parameters.size())};
  std::optional<NearestBorder> nearest;
  for (int b = 0; b < base.border_count(regime); ++b) {
    if (b == except) continue;
    const double value = base.border(point.unknowns, point.parameters, regime, b, &gradient);
    const double slope = std::hypot(gradient.unknowns.cwiseProduct(unknowns).norm(),
                                    gradient.parameters(active) * parameters(active));
    const double distance = -value / slope;
    if (!nearest || std::abs(distance) < std::abs(nearest->distance)) nearest = {b, distance};
  }
  return nearest;
}

CornerSlopes::CornerSlopes(const Problem& base, Index active, Index observable)
    : base_(base),
      active_(active),
      observable_(observable),
      corrector_(base, active, {}),
      at_(corrector_.make_point()) {
  gradient_ = {Vector::Zero(base.size()), Vector::Zero(at_.parameters.size())};
}

bool CornerSlopes::set_tangent(const BasePoint& point, Branch& side) {
  at_.unknowns = point.unknowns;
  at_.parameters = point.parameters;
  at_.regime = side.regime;
  corrector_.set_scale(at_);
  const Index n = base_.size();
  Correction result = Correction::singular;
  if (side.tangent.size() > 0) result = corrector_.linearise(at_, side.tangent);
  // The unit vectors in turn: one of them is not orthogonal to the tangent.
  for (Index k = n; k >= 0 && result == Correction::singular; --k)
    result = corrector_.linearise(at_, Vector::Unit(n + 1, k));
  if (result != Correction::converged) return false;
  const Vector before = side.tangent;
  side.tangent = corrector_.direction().normalized();
  if (before.size() > 0 && before.dot(side.tangent) < 0) side.tangent = -side.tangent;
  return true;
}

double CornerSlopes::border_rate(const BasePoint& point, const Branch& side) {
  base_.border(point.unknowns, point.parameters, side.regime, side.border, &gradient_);
  return rate(gradient_, active_, at_.scale, side.tangent);
}

/// The border of the regime beyond one that leads back across it; where several meet, the nearest need not.
std::optional<int> CornerSlopes::way_back(const BasePoint& point, const Regime& beyond) const {
  std::optional<int> back;
  double nearest = 0;
  for (int b = 0; b < base_.border_count(beyond); ++b) {
    if (base_.regime_beyond(beyond, b) != point.regime) continue;
    const double value = std::abs(base_.border(point.unknowns, point.parameters, beyond, b, nullptr));
    if (back && value >= nearest) continue;
    back = b;
    nearest = value;
  }
  if (back) return back;
  const auto any = nearest_border(base_, active_, point, beyond);
  return any ? std::optional(any->border) : std::nullopt;
}

/// The regime beyond a border and all those that the branch comes to together with it, as borders do that a
/// symmetry makes one.
std::optional<Regime> CornerSlopes::beyond(const BasePoint& point, int border) {
  constexpr double same = 1e-8;  // a value or a rate: points are known to 1e-10
  auto beyond = base_.regime_beyond(point.regime, border);
  Branch branch{point.regime, border, {}};
  if (!beyond || base_.border_count(point.regime) < 2 || !set_tangent(point, branch)) return beyond;
  const auto along = [&](int b) {
    branch.border = b;
    return border_rate(point, branch);
  };
  const auto value = [&](int b) {
    return base_.border(point.unknowns, point.parameters, point.regime, b, nullptr);
  };
  const double rate = along(border);
  for (int b = 0; b < base_.border_count(point.regime); ++b) {
    const auto next = base_.regime_beyond(point.regime, b);
    const bool together = std::abs(value(b) - value(border)) <= same && std::abs(along(b) - rate) <= same;
    if (b == border || !next || !together) continue;
    for (Index i = 0; i < base_.switch_count(); ++i)
      if ((*next)[i] != point.regime[i]) beyond = beyond->with(i, (*next)[i]);
  }
  return beyond;
}

bool CornerSlopes::begin(const BasePoint& point, int border) {
  const auto beyond = this->beyond(point, border);
  const auto back = beyond ? way_back(point, *beyond) : std::nullopt;
  if (!back) return false;
  sides_ = {Branch{point.regime, border, {}}, Branch{*beyond, *back, {}}};
  for (const Side side : {arriving, leaving}) {
    Branch& branch = sides_[side];
    if (!set_tangent(point, branch)) return false;
    if ((border_rate(point, branch) > 0) != (side == arriving)) branch.tangent = -branch.tangent;
  }
  return true;
}

/// A point that lies on the border but for rounding, by no more than that beyond it: inside, where the slope
/// may grow like the square root of the distance, that rounding would show in eight digits less.
BasePoint CornerSlopes::just_beyond(const BasePoint& point, const Branch& side) {
  constexpr double rounding = 1e-13;
  constexpr double beyond = 2e-15;
  const double value = base_.border(point.unknowns, point.parameters, side.regime, side.border, &gradient_);
  const double square = gradient_.unknowns.squaredNorm();
  BasePoint moved = point;
  if (std::abs(value) < rounding && square > 0)
    moved.unknowns += (beyond - value) / square * gradient_.unknowns;
  return moved;
}

double CornerSlopes::slope(const BasePoint& point, Side side) {
  Branch there = sides_[side];
  const BasePoint at = just_beyond(point, there);
  if (!set_tangent(at, there)) return std::nan("");
  const double value = base_.observe(at.unknowns, at.parameters, there.regime, observable_, gradient_);
  return rate(gradient_, active_, at_.scale, there.tangent) / std::abs(value);
}

bool CornerSlopes::touch(const BasePoint& point, double rate) {
  return std::all_of(sides_.begin(), sides_.end(), [&](const Branch& side) {
    Branch there = side;
    return set_tangent(point, there) && std::abs(border_rate(point, there)) <= rate;
  });
}

void CornerSlopes::follow(const BasePoint& point) {
  for (Branch& side : sides_) set_tangent(point, side);
}

std::optional<BasePoint> CornerSlopes::inside(const BasePoint& corner, Side side, double way) {
  Branch there = sides_[side];
  if (!set_tangent(corner, there)) return std::nullopt;
  const Vector normal = (border_rate(corner, there) > 0 ? -1 : 1) * there.tangent;
  const CurvePoint origin = at_;
  corrector_.displace(origin, way * normal, at_);
  if (corrector_.correct(at_, origin, normal, way, true) != Correction::converged) return std::nullopt;
  return BasePoint{at_.unknowns, at_.parameters, there.regime, {}};
}

double CornerSlopes::slope_inside(const BasePoint& corner, Side side, double way) {
  const auto point = inside(corner, side, way);
  return point ? slope(*point, side) : std::nan("");
}

namespace {
constexpr double nearest_inside = 1e-14;  // in the scale
}

std::optional<BasePoint> CornerSlopes::extremum_inside(const BasePoint& corner, Side side, double from) {
  constexpr double farthest = 0.1;
  double before = from;
  double at_before = from > 0 ? slope_inside(corner, side, from) : slope(corner, side);
  for (double way = 4 * std::max(from, nearest_inside); way < farthest; way *= 4) {
    const double here = slope_inside(corner, side, way);
    if (std::isnan(here)) return std::nullopt;
    if (here * at_before <= 0) {
      const auto at = [&](double s) { return slope_inside(corner, side, s); };
      return inside(corner, side, zero_between(at, before, way, at_before, here));
    }
    before = way;
    at_before = here;
  }
  return std::nullopt;
}

std::optional<CornerSlopes::Steepest> CornerSlopes::steepest_inside(const BasePoint& corner, Side side,
                                                                    double sign, double farthest) {
  const double unit = sign < 0 ? -1 : 1;
  constexpr int half_the_digits = 26;
  const auto falls = [&](double log_way) { return -unit * slope_inside(corner, side, std::exp(log_way)); };
  // Brent's search begins in the middle; the slope first rises from the border.
  double best = std::log(nearest_inside);
  double least = std::numeric_limits<double>::infinity();
  for (double way = nearest_inside; way <= farthest; way *= 2) {
    const double here = falls(std::log(way));
    if (here < least) {
      least = here;
      best = std::log(way);
    }
  }
  const double reach = std::log(2.0);
  const auto [place, value] =
      boost::math::tools::brent_find_minima(falls, best - reach, best + reach, half_the_digits);
  const auto point = inside(corner, side, std::exp(place));
  if (!point) return std::nullopt;
  return Steepest{*point, -value};
}

}  // namespace arcslip::continuation
