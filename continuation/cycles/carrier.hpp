#pragma once

// Solutions of one mesh on another.

#include <algorithm>
#include <limits>

#include "arcslip/continuation/cycles/orbit_problem.hpp"
#include "arcslip/zero_between.hpp"

namespace arcslip::continuation {

/// Vectors of one frame in another one.
class Carrier {
 public:
  Carrier(const OrbitProblem& problem, const Regime& from, const Regime& to)
      : problem_(problem), from_(problem.frame(from).mesh), to_(problem.frame(to).mesh), regime_(to) {}

  /// n + 1 or n entries, of which those of the orbit change.
  Vector operator()(const Vector& all) const { return turned(all, turn_); }

  /// From here on orbits begin where the condition on the phase has it for one of them; where it has several
  /// places, at the one nearest to an orbit of the new frame.
  void turn_to(const Vector& from, const Vector& to) {
    const OrbitFrame& frame = problem_.frame(regime_);
    const Index count = frame.phase.size();
    if (count == 0) return;
    const auto slide = [&](double turn) {  // grows where both move alike
      return frame.phase.dot(turned(from, turn).head(count)) - frame.phase_value;
    };
    const double spacing = 0.5 / static_cast<double>(to_.intervals());
    double least = std::numeric_limits<double>::infinity();
    double before = slide(-0.5);
    for (double turn = -0.5; turn < 0.5; turn += spacing) {
      const double behind = slide(turn + spacing);
      if (before < 0 && behind >= 0) {
        const double there = zero_between(slide, turn, turn + spacing, before, behind);
        const double distance = (turned(from, there) - to).head(count).norm();
        if (distance < least) turn_ = there;
        least = std::min(least, distance);
      }
      before = behind;
    }
  }

 private:
  Vector turned(const Vector& all, double turn) const {
    Vector result = all;
    const Matrix orbit = problem_.orbit(all);
    auto carried = result.head(orbit.size()).reshaped(orbit.rows(), orbit.cols());
    if (turn == 0) {
      carried = from_.carried(orbit, to_);
      return result;
    }
    const Vector s = to_.places().array() + turn;
    const Vector rounds = s.array().floor();
    carried = from_.at(orbit, from_.find(s - rounds));
    carried += (orbit.rightCols(1) - orbit.col(0)) * rounds.transpose();
    return result;
  }

  const OrbitProblem& problem_;
  const OrbitMesh& from_;
  const OrbitMesh& to_;
  Regime regime_;
  double turn_ = 0;  // of a whole round
};

}  // namespace arcslip::continuation
