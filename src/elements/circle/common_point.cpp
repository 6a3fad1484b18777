#include "elements/circle/common_point.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "arcslip/dense.hpp"

namespace arcslip {
namespace {

using Touch = CommonPoint::Touch;

/// A disc at one theta.
struct Disc {
  double angle;
  Complex centre;
  double radius;
};

/// What a few discs determine.
struct Found {
  Complex offset;
  double measure;  // grows with the discs that count
  std::vector<Touch> touches;
};

/// Where three discs grown by the same touch one point that they surround.
std::optional<Found> between(const Disc& first, const Disc& second, const Disc& third) {
  constexpr double rounding = 1e-12;
  const Complex a = second.centre - first.centre;
  const Complex b = third.centre - first.centre;
  const double more_a = second.radius - first.radius;
  const double more_b = third.radius - first.radius;
  const double area = cross(a, b);
  if (!(std::abs(area) > rounding * std::abs(a) * std::abs(b))) return std::nullopt;
  // d = p + q t about the first centre, |d| = t
  const auto solved = [&](double of_a, double of_b) {
    return Complex(of_a * b.imag() - of_b * a.imag(), of_b * a.real() - of_a * b.real()) / area;
  };
  const Complex p = solved(0.5 * (std::norm(a) - more_a * more_a), 0.5 * (std::norm(b) - more_b * more_b));
  const Complex q = solved(-more_a, -more_b);
  const double square = std::norm(q) - 1;
  const double root = std::sqrt(std::max(0.0, dot(p, q) * dot(p, q) - square * std::norm(p)));
  const double larger = -dot(p, q) - std::copysign(root, dot(p, q));
  for (const double t : {larger / square, std::norm(p) / larger}) {
    if (!(std::isfinite(t) && t >= 0 && t + more_a >= 0 && t + more_b >= 0)) continue;
    const Complex d = p + q * t;
    const Complex one = -d;
    const Complex two = a - d;
    const Complex three = b - d;
    double weights[] = {cross(two, three) * std::abs(one), cross(three, one) * std::abs(two),
                        cross(one, two) * std::abs(three)};
    const double sum = weights[0] + weights[1] + weights[2];
    bool surround = sum != 0;
    for (double& weight : weights) {
      weight /= sum;
      surround = surround && weight >= -rounding;
    }
    if (!surround) continue;
    return Found{first.centre + d,
                 t - first.radius,
                 {{first.angle, weights[0]}, {second.angle, weights[1]}, {third.angle, weights[2]}}};
  }
  return std::nullopt;
}

/// The least excess of a few discs: that of one, two or three of them which is greatest.
Found least_excess_of(const std::vector<Disc>& discs) {
  Found best{0, -std::numeric_limits<double>::infinity(), {}};
  const auto take = [&](const Found& one) {
    if (one.measure > best.measure) best = one;
  };
  for (std::size_t i = 0; i < discs.size(); ++i) {
    const Disc& a = discs[i];
    take({a.centre, -a.radius, {{a.angle, 1}}});
    for (std::size_t j = 0; j < i; ++j) {
      const Disc& b = discs[j];
      const double apart = std::abs(b.centre - a.centre);
      if (apart > std::abs(a.radius - b.radius)) {
        const double excess = 0.5 * (apart - a.radius - b.radius);
        take({a.centre + (b.centre - a.centre) * ((a.radius + excess) / apart),
              excess,
              {{a.angle, 0.5}, {b.angle, 0.5}}});
      }
      for (std::size_t k = 0; k < j; ++k) {
        if (const auto three = between(a, b, discs[k])) take(*three);
      }
    }
  }
  return best;
}

/// Maxima of a polynomial, the highest first, and its lowest minimum.
struct Extremes {
  explicit Extremes(const PeriodicMotion& excess) {
    std::vector<double> turns = excess.derivative().zeros();
    if (turns.empty()) turns.push_back(0);
    for (const double angle : turns) maxima.emplace_back(excess.value(angle), angle);
    std::sort(maxima.rbegin(), maxima.rend());
    lowest = maxima.back().second;
  }
  std::vector<std::pair<double, double>> maxima;
  double lowest;
};

/// Whether a measure has grown, as it does until rounding lets it no more.
bool grows(const CircleMotion& motion, double measure, double& last) {
  constexpr double rounding = 1e-15;
  const bool does = measure > last + rounding * motion.size();
  last = measure;
  return does;
}

/// Keeps the discs that count and adds those that are exceeded most; false where none is.
bool exchange(const CircleMotion& motion, const Found& found, const Extremes& extremes,
              std::vector<Disc>& discs) {
  constexpr double rounding = 1e-15;
  constexpr std::size_t most_new = 3;
  std::erase_if(discs, [&](const Disc& one) {
    return std::none_of(found.touches.begin(), found.touches.end(),
                        [&](const Touch& touch) { return touch.angle == one.angle; });
  });
  const std::size_t kept = discs.size();
  for (const auto& [value, angle] : extremes.maxima) {
    if (!(value > rounding * motion.size() * motion.size()) || discs.size() == kept + most_new) break;
    if (std::any_of(discs.begin(), discs.end(), [&, at = angle](const Disc& one) { return one.angle == at; }))
      continue;
    const CircleMotion::Local here = motion.at(angle);
    discs.push_back({angle, here.centre, here.radius});
  }
  return discs.size() > kept;
}

/// With the discs where they are exceeded most: of two beside one maximum, both found on the way there, one.
std::vector<Touch> merged(const std::vector<Touch>& touches, const Extremes& extremes) {
  std::vector<Touch> all;
  for (const Touch& touch : touches) {
    const auto distance = [&](double angle) { return std::abs(std::remainder(angle - touch.angle, two_pi)); };
    const double angle =
        std::min_element(extremes.maxima.begin(), extremes.maxima.end(), [&](const auto& a, const auto& b) {
          return distance(a.second) < distance(b.second);
        })->second;
    const auto same =
        std::find_if(all.begin(), all.end(), [&](const Touch& one) { return one.angle == angle; });
    if (same == all.end())
      all.push_back({angle, touch.weight});
    else
      same->weight += touch.weight;
  }
  return all;
}

/// Newton's method for all that determines the place: that no disc is exceeded by more than rounding tells
/// it only to its root.
CommonPoint polished(const CircleMotion& motion, CommonPoint point) {
  constexpr int steps = 3;
  constexpr double farthest = 1e-3;
  if (point.touches.size() == 1) return point;
  for (int i = 0; i < steps; ++i) {
    const TouchConditions here(motion, point);
    const Vector step = shortest(here.by, Vector(-here.rest));
    CommonPoint next = point;
    const Index count = std::ssize(point.touches);
    next.offset += Complex(step(0), step(1));
    next.excess += step(2);
    for (Index k = 0; k < count; ++k) {
      Touch& touch = next.touches[static_cast<std::size_t>(k)];
      touch.angle += step(3 + count + k);
      const double weight = here.weight(k) + step(3 + k);
      touch.weight = weight * (motion.at(touch.angle).radius + next.excess);
    }
    if (!(step.head<3>().norm() < farthest * motion.size() && step.tail(count).norm() < farthest)) break;
    point = next;
  }
  return point;
}

}  // namespace

CommonPoint least_excess(const CircleMotion& motion, double enough) {
  const double first = Extremes(motion.press()).lowest;
  const CircleMotion::Local least = motion.at(first);
  std::vector<Disc> discs{{first, least.centre, least.radius}};
  double last = -std::numeric_limits<double>::infinity();
  for (;;) {
    const Found found = least_excess_of(discs);
    const Extremes extremes(motion.excess(found.offset, found.measure));
    CommonPoint point{found.offset, found.measure, found.touches, extremes.lowest};
    if (found.measure > enough) return point;
    const bool goes_on = exchange(motion, found, extremes, discs) && grows(motion, found.measure, last);
    if (goes_on) continue;
    point.touches = merged(found.touches, extremes);
    return polished(motion, point);
  }
}

/// From the end of the way backwards, each time to where the disc lets it that is exceeded most.
RestingPlace::RestingPlace(const CircleMotion& motion) : offset(-motion.mean()), centre{}, part(1), angle(0) {
  constexpr int most_rounds = 100;
  constexpr double rounding = 1e-15;
  const double zero = rounding * motion.size() * motion.size();
  const Complex rest = offset;
  for (int round = 0; round < most_rounds; ++round) {
    const auto [excess, at] = Extremes(motion.excess(offset, 0)).maxima.front();
    if (excess <= zero) {
      if (round > 0) angle = at;  // to rounding, not to its root
      return;
    }
    if (round == 0) centre = least_excess(motion, std::numeric_limits<double>::infinity());
    if (centre.excess >= 0) break;
    const CircleMotion::Local disc = motion.at(at);
    const Complex way = rest - centre.offset;
    const Complex pull = disc.centre - centre.offset;
    const double along = dot(pull, way) / std::norm(way);
    const double rest_square = (disc.radius * disc.radius - std::norm(pull)) / std::norm(way);
    const double next = along + std::sqrt(std::max(0.0, along * along + rest_square));
    angle = at;
    if (!(next < part)) return;
    part = next;
    offset = centre.offset + part * way;
  }
  if (centre.excess < 0) return;
  part = 0;
  offset = centre.offset;
}

TouchConditions::TouchConditions(const CircleMotion& motion, const CommonPoint& point) {
  const Index count = std::ssize(point.touches);
  by.setZero(3 + 2 * count, 3 + 2 * count);
  rest.setZero(3 + 2 * count);
  weight.resize(count);
  rest(2) = 1;
  for (Index k = 0; k < count; ++k) {
    const Touch& touch = point.touches[static_cast<std::size_t>(k)];
    const CircleMotion::Local w = motion.at(touch.angle);
    const Complex pull = w.centre - point.offset;
    const double radius = w.radius + point.excess;
    const double own = weight(k) = radius > 0 ? touch.weight / radius : touch.weight;
    const Index by_weight = 3 + k;
    const Index by_angle = 3 + count + k;
    by.diagonal().head<3>() += own * Eigen::Vector3d(1, 1, -1);
    by.col(by_weight).head<3>() << -pull.real(), -pull.imag(), -radius;
    by.col(by_angle).head<3>() << -own * w.rate.real(), -own * w.rate.imag(), -own * w.radius_rate;
    by.row(by_weight).head<3>() << -pull.real(), -pull.imag(), -radius;
    by.row(by_angle).head<3>() << -w.rate.real(), -w.rate.imag(), -w.radius_rate;
    by(by_angle, by_angle) =
        std::norm(w.rate) + dot(pull, w.bend) - w.radius_rate * w.radius_rate - radius * w.radius_bend;
    rest.head<3>() -= own * Eigen::Vector3d(pull.real(), pull.imag(), radius);
    rest(by_weight) = 0.5 * (std::norm(pull) - radius * radius);
    rest(by_angle) = dot(pull, w.rate) - radius * w.radius_rate;
  }
}

CircleMotion slipping_motion(const CircleMotion& motion, const CommonPoint& least) {
  return motion.tightened(std::max(0.0, hardly_slips * motion.size() - least.excess));
}

}  // namespace arcslip
