#include "arcslip/continuation/path/repetition.hpp"

#include <algorithm>
#include <cmath>

namespace arcslip::continuation {

std::optional<std::size_t> came_round(const Problem& problem, const std::vector<BranchPoint>& points,
                                      Index active, const Tolerances& tolerances) {
  constexpr double far = 1e-3;  // in the problem's scale
  if (points.empty() || !is_turn(points.back().type)) return std::nullopt;
  const BranchPoint& last = points.back();
  const Index n = last.unknowns.size();
  Vector unknowns(n);
  Vector parameters(last.parameters.size());
  problem.scale(last.unknowns, last.parameters, unknowns, parameters);
  Vector scale(n + 1);
  scale << unknowns * std::sqrt(static_cast<double>(n)), parameters(active);
  const auto distance = [&](const BranchPoint& other) {
    return std::hypot((other.unknowns - last.unknowns).cwiseQuotient(scale.head(n)).norm(),
                      (other.parameters(active) - last.parameters(active)) / scale(n));
  };
  const Vector direction = last.tangent.cwiseQuotient(scale).normalized();
  double farthest = 0;
  for (std::size_t i = points.size() - 1; i-- > 0;) {
    const BranchPoint& other = points[i];
    const double from_last = distance(other);
    farthest = std::max(farthest, from_last);
    if (!is_turn(other.type) || farthest < far || from_last > tolerances.same_point) continue;
    const bool is_same_way = other.tangent.cwiseQuotient(scale).normalized().dot(direction) > 0;
    if (other.regime == last.regime && is_same_way) return i;
  }
  return std::nullopt;
}

bool stands_still(const Problem& problem, const std::vector<BranchPoint>& points, Index active,
                  const Tolerances& tolerances) {
  constexpr std::size_t many = 8;  // of no curve at a distance of rounding
  if (points.size() < many || !is_turn(points.back().type)) return false;
  const BranchPoint& last = points.back();
  Vector unknowns(last.unknowns.size());
  Vector scale(last.parameters.size());
  problem.scale(last.unknowns, last.parameters, unknowns, scale);
  return std::all_of(points.end() - many, points.end(), [&](const BranchPoint& point) {
    return is_turn(point.type) && std::abs(point.parameters(active) - last.parameters(active)) <=
                                      tolerances.same_value * scale(active);
  });
}

std::optional<std::size_t> turns_in_place(const std::vector<BranchPoint>& points,
                                          const Tolerances& tolerances) {
  constexpr int many = 20;   // turns of no curve on so short a way; one fold may be found a few times
  constexpr int rows = 100;  // of any type, as of a point between two pieces that go back and forth
  if (points.empty()) return std::nullopt;
  const double end = points.back().arclength;
  std::size_t first = points.size();
  int turns = 0;
  int all = 0;
  for (std::size_t i = points.size();
       i-- > 0 && std::abs(end - points[i].arclength) <= tolerances.same_point;) {
    ++all;
    if (!is_turn(points[i].type)) continue;
    first = i;
    ++turns;
  }
  if (all >= rows) return points.size() - static_cast<std::size_t>(all);
  return is_turn(points.back().type) && turns >= many ? std::optional(first) : std::nullopt;
}

}  // namespace arcslip::continuation
