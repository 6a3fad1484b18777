#pragma once

// f(u, p, q) = 0 as a problem, given as a function of all three with its gradient.

#include <Eigen/Core>
#include <functional>

#include "arcslip/continuation/atlas/atlas.hpp"
#include "scalar_problem.hpp"

namespace arcslip::testing {

using Place = Eigen::Vector3d;  // u, p, q

/// For unknowns of another size if that is given.
inline ScalarProblem level_set(std::function<double(const Place&)> f,
                               std::function<Place(const Place&)> gradient, double size = 1) {
  const auto at = [size](double u, const Vector& p) { return Place(u / size, p(0), p(1)); };
  const auto slope = [=](Index which) {
    return [=](double u, const Vector& p) { return gradient(at(u, p))(which); };
  };
  return ScalarProblem(
      {"p", "q"}, [=](double u, const Vector& p) { return f(at(u, p)); },
      [=](double u, const Vector& p) { return gradient(at(u, p))(0) / size; }, {slope(1), slope(2)});
}

/// u^2 + p^3 - p = q.
inline ScalarProblem cubic_sheet() {
  return level_set([](const Place& z) { return z(0) * z(0) + z(1) * z(1) * z(1) - z(1) - z(2); },
                   [](const Place& z) { return Place(2 * z(0), 3 * z(1) * z(1) - 1, -1); });
}

inline continuation::Guess start(double u, double p, double q) {
  return {vector_of({u}), vector_of({p, q}), {}, {}};
}

inline continuation::AtlasOptions box(double reach, double max_radius = 0.1) {
  continuation::AtlasOptions options;
  options.parameters = {"p", "q"};
  options.from = {-reach, -reach};
  options.to = {reach, reach};
  options.max_radius = max_radius;
  return options;
}

}  // namespace arcslip::testing
