#include "arcslip/continuation/atlas/zero_curves.hpp"

#include <algorithm>
#include <cmath>

#include "arcslip/continuation/points/normal_form.hpp"
#include "arcslip/zero_between.hpp"

namespace arcslip::continuation {
namespace {

constexpr double one_place = 1e-9;  // distance of places that are the same
constexpr double vanishes = 1e-12;  // what a function of size 1 does but for rounding

struct NoPlace {};  // leaves the search for a zero

double apart(const ZeroPoint& a, const ZeroPoint& b) { return (a.at - b.at).norm(); }

/// A test of a point, signed as at another one.
double test_like(const ZeroPoint& point, Index test, const ZeroPoint& other) {
  return point.sense.dot(other.sense) < 0 ? -point.tests(test) : point.tests(test);
}

}  // namespace

ZeroCurves::ZeroCurves(const Problem& problem, Surface& surface, Covering& covering,
                       const Triangulation& triangles)
    : problem_(problem), surface_(surface), covering_(covering), triangles_(triangles) {
  for (const Disc& disc : covering.discs())
    orientations_.push_back(!surface.tangent(disc.at, disc.plane, plane_) || surface.orientation(plane_) > 0);
}

std::vector<bool> ZeroCurves::signs(const std::vector<double>& values) const {
  const auto value = [&](int disc) { return values[static_cast<std::size_t>(disc)]; };
  std::vector<double> low = values;  // of each disc and those beside it
  std::vector<double> high = values;
  for (const Triangulation::Face& face : triangles_.faces()) {
    const auto [least, most] = std::minmax({value(face[0]), value(face[1]), value(face[2])});
    for (const int disc : face) {
      const auto i = static_cast<std::size_t>(disc);
      low[i] = std::min(low[i], least);
      high[i] = std::max(high[i], most);
    }
  }
  std::vector<bool> positive;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const bool is_rim = covering_.discs()[i].sides != 0 && low[i] >= -vanishes && high[i] > vanishes;
    positive.push_back(values[i] > (is_rim ? vanishes : -vanishes));
  }
  return positive;
}

/// Where the function vanishes above the straight way between two places in a disc's plane, on sides of the
/// box that both are on.
std::optional<ZeroPoint> ZeroCurves::between(SurfaceFunction& function, const Disc& disc, const Vector& a,
                                             const Vector& b, int sides) {
  ZeroPoint found{a, &disc};
  const auto value = [&](double share) {
    found.at = a + share * (b - a);
    if (!covering_.lift(disc, found.at, sides) || !surface_.tangent(found.at, disc.plane, plane_))
      throw NoPlace();
    return function.value(found.at, plane_);
  };
  try {
    const double at_a = value(0);
    const double at_b = value(1);
    if (at_a * at_b > 0 && std::min(std::abs(at_a), std::abs(at_b)) > vanishes) return std::nullopt;
    value(zero_between(value, 0, 1, at_a, at_b));
  } catch (const NoPlace&) {
    return std::nullopt;
  }
  if (!function.look(plane_, found)) return std::nullopt;
  return found;
}

/// Where sheets cross next to the middle of an edge, at its value of one of the parameters: a branch point.
std::optional<ZeroPoint> ZeroCurves::crossing(const Disc& a, const Disc& b) {
  constexpr double unfolded = 1e-8;  // F, which 1 is large of, but for how well the point is located
  const Vector middle = 0.5 * (a.at + b.at);
  const Guess guess = surface_.solution(middle);
  for (const int moving : {0, 1}) {
    if ((a.sides & b.sides & 3 << 2 * moving) != 0) continue;  // on a side of its own
    BranchPointProblem extended(problem_, surface_.sides()[static_cast<std::size_t>(moving)].parameter);
    const auto found = locate(extended, {guess.unknowns, guess.parameters, guess.regime, Vector::Zero(1)});
    if (!found || std::abs(found->point.extras(0)) > unfolded) continue;
    const Vector at = surface_.place({found->point.unknowns, found->point.parameters, guess.regime, {}});
    if ((at - middle).norm() <= (a.at - b.at).norm()) return ZeroPoint{at, &a, true};
  }
  return std::nullopt;
}

/// Between two neighbours on a curve where a test changes sign, by zeros across it within the zero along it.
std::optional<ZeroPoint> ZeroCurves::special(SurfaceFunction& function, const ZeroPoint& a,
                                             const ZeroPoint& b, Index test) {
  const Disc& disc = *a.disc;
  const Eigen::Vector2d along = disc.plane.transpose() * (b.at - a.at);
  const Vector across = disc.plane * Eigen::Vector2d(-along(1), along(0));
  std::optional<ZeroPoint> found;
  const auto value = [&](double share) {
    const Vector middle = a.at + share * (b.at - a.at);
    for (double width = 0.05; width < 2; width *= 2) {
      found = between(function, disc, middle - width * across, middle + width * across, 0);
      if (found) break;
    }
    if (!found) throw NoPlace();
    return test_like(*found, test, a);
  };
  try {
    value(zero_between(value, 0, 1, a.tests(test), test_like(b, test, a)));
  } catch (const NoPlace&) {
    return std::nullopt;
  }
  found->zero = static_cast<int>(test);
  return found;
}

/// Points that follow each other, with the zeros of tests on them and between them.
ZeroCurves::Curve ZeroCurves::with_specials(SurfaceFunction& function, Curve points) {
  points.erase(std::unique(points.begin(), points.end(),
                           [](const ZeroPoint& a, const ZeroPoint& b) { return apart(a, b) < one_place; }),
               points.end());
  Vector largest;
  for (const ZeroPoint& one : points) {
    if (one.is_crossing) continue;
    largest =
        largest.size() > 0 ? largest.cwiseMax(one.tests.cwiseAbs()).eval() : one.tests.cwiseAbs().eval();
  }
  const auto is_zero = [&](const ZeroPoint& one, Index test) {
    return std::abs(one.tests(test)) <= one_place * largest(test);
  };
  for (ZeroPoint& one : points) {
    for (Index test = largest.size(); !one.is_crossing && test-- > 0;) {
      if (largest(test) > one_place && is_zero(one, test)) one.zero = static_cast<int>(test);
    }
  }
  Curve all;
  for (std::size_t i = 0; i < points.size(); ++i) {
    all.push_back(points[i]);
    if (i + 1 == points.size()) break;
    const ZeroPoint& here = points[i];
    const ZeroPoint& next = points[i + 1];
    const auto first = all.end() - all.begin();
    for (Index test = 0; test < largest.size() && !here.is_crossing && !next.is_crossing; ++test) {
      if (largest(test) <= one_place || is_zero(here, test) || is_zero(next, test)) continue;
      if (here.tests(test) * test_like(next, test, here) > 0) continue;
      if (auto found = special(function, here, next, test)) {
        all.push_back(std::move(*found));
      } else {
        has_failed_ = true;
      }
    }
    std::sort(all.begin() + first, all.end(),
              [&](const ZeroPoint& a, const ZeroPoint& b) { return apart(a, here) < apart(b, here); });
  }
  return all;
}

/// The curve from one of the edges on, each of which leads to those beside it.
ZeroCurves::Curve ZeroCurves::follow(SurfaceFunction& function,
                                     const std::map<Edge, std::vector<Edge>>& beside, Edge edge,
                                     std::map<Edge, bool>& passed) {
  const Edge first = edge;
  Curve points;
  for (bool goes_on = true; goes_on;) {
    passed[edge] = true;
    const Disc& a = covering_.discs()[static_cast<std::size_t>(edge.first)];
    const Disc& b = covering_.discs()[static_cast<std::size_t>(edge.second)];
    if (auto point = function.vanishes_at_crossings() && turns_over(edge)
                         ? crossing(a, b)
                         : between(function, a, a.at, b.at, a.sides & b.sides)) {
      points.push_back(std::move(*point));
    } else {
      has_failed_ = true;
    }
    const std::vector<Edge>& next = beside.at(edge);
    const auto on = std::find_if(next.begin(), next.end(), [&](const Edge& one) { return !passed[one]; });
    goes_on = on != next.end();
    if (goes_on) edge = *on;
  }
  const std::vector<Edge>& last = beside.at(edge);
  if (beside.at(first).size() == 2 && std::count(last.begin(), last.end(), first) > 0 && !points.empty())
    points.push_back(points.front());
  return with_specials(function, std::move(points));
}

std::vector<ZeroCurves::Curve> ZeroCurves::find(SurfaceFunction& function,
                                                const std::function<bool(const Edge&)>& has_zero) {
  std::map<Edge, std::vector<Edge>> beside;
  for (const Triangulation::Face& face : triangles_.faces()) {
    std::vector<Edge> crossed;
    for (std::size_t i = 0; i < 3; ++i) {
      const Edge edge = std::minmax(face[i], face[(i + 1) % 3]);
      if (has_zero(edge)) crossed.push_back(edge);
    }
    if (crossed.size() != 2) continue;
    beside[crossed[0]].push_back(crossed[1]);
    beside[crossed[1]].push_back(crossed[0]);
  }
  std::map<Edge, bool> passed;
  std::vector<Curve> curves;
  for (const bool from_ends : {true, false}) {
    for (const auto& [edge, next] : beside) {
      if (!passed[edge] && (next.size() == 1) >= from_ends)
        curves.push_back(follow(function, beside, edge, passed));
    }
  }
  return curves;
}

}  // namespace arcslip::continuation
