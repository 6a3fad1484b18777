#pragma once

// By what an orbit is known whatever its mesh and its phase are.

#include <algorithm>
#include <cmath>

#include "arcslip/continuation/cycles/orbit_problem.hpp"

namespace arcslip::continuation {

struct OrbitMark {
  double value;  // of the parameter, in its scale
  Vector observed;
};

/// Of a point or a guess.
template <class Solution>
OrbitMark mark_of(const OrbitProblem& problem, const Solution& at, Index parameter) {
  OrbitMark mark{at.parameters(parameter), {}};
  problem.observe(at.unknowns, at.parameters, at.regime, mark.observed);
  return mark;
}

/// Whether two that are located as well, on meshes of their own, are one.
inline bool is_same(const OrbitMark& one, const OrbitMark& other) {
  constexpr double same = 1e-5;
  const Vector size = one.observed.cwiseAbs().cwiseMax(1e-3 * one.observed.lpNorm<Eigen::Infinity>());
  return std::abs(other.value - one.value) <= same * std::max(1.0, std::abs(one.value)) &&
         (other.observed - one.observed).cwiseQuotient(size).lpNorm<Eigen::Infinity>() < 10 * same;
}

}  // namespace arcslip::continuation
