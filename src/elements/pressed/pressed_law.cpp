#include "arcslip/elements/pressed/pressed_law.hpp"

#include <cmath>

namespace arcslip {
namespace {

using Arc = PressedArcs::Arc;
using Phase = PressedArcs::Phase;

/// How long before an arc its slider was set.
double lead(const Arc& arc) {
  constexpr double rounding = 1e-9;
  const double before = arc.begin - arc.anchor;
  const double turned = before - two_pi * std::floor(before / two_pi);
  return turned > two_pi - rounding ? 0 : turned;
}

}  // namespace

DisturbedLaw pressed_law(const PressedSettings& settings, const PressedArcs& course, Index coordinates) {
  const double k = settings.tangential_stiffness;
  const auto cut = [&](const Matrix& both) { return Matrix(both.topLeftCorner(coordinates, coordinates)); };
  DisturbedLaw law;
  law.coordinates = coordinates;
  for (const Arc& arc : course.arcs()) {
    Matrix stiffness = Matrix::Zero(2, 2);
    if (arc.phase != Phase::apart) stiffness(1, 1) = settings.normal_stiffness;
    if (arc.phase == Phase::stick) stiffness(0, 0) = k;
    if (arc.phase == Phase::slip) {
      stiffness(0, 1) = arc.direction * settings.friction * settings.normal_stiffness;
    }
    law.pieces.push_back({arc.begin, arc.width, cut(stiffness)});
    if (arc.phase != Phase::stick || !arc.is_set || course.is_stuck()) continue;
    const Vector set = Eigen::Vector2d(k, arc.by_press * settings.normal_stiffness).head(coordinates);
    const Vector force = Eigen::Vector2d(-1, 0).head(coordinates);
    law.pieces.back().held = {{std::ssize(law.memories), force}};
    law.memories.push_back({arc.begin - lead(arc), arc.width + lead(arc), set});
  }
  return law;
}

}  // namespace arcslip
