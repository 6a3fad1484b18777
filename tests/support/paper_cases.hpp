#pragma once

// The paper's systems, shared by tests.

#include <algorithm>
#include <cmath>
#include <vector>

#include "arcslip/problems/response/forced_response.hpp"
#include "branches.hpp"

namespace arcslip::testing {

/// Figure 8: beams, M* = 5, gamma = 4, L/h_D = 33.3, n = 1, N = 30, F = 1, zeta = 1e-4.
inline SystemParameters figure_8(double preload) {
  SystemParameters parameters;
  parameters.mass_ratio = 5;
  parameters.frequency_ratio = 4;
  parameters.interface_stiffness = shear_interface_stiffness(33.3, 0.3);
  parameters.preload = preload;
  return parameters;
}

/// Rods with K_FD = 1000, the rest as in figure 8.
inline SystemParameters rods(double preload) {
  SystemParameters parameters = figure_8(preload);
  parameters.model = StructureModel::rods;
  parameters.interface_stiffness = 1000;
  return parameters;
}

inline continuation::TraceOptions over_eta(double from, double to) {
  continuation::TraceOptions options = over("eta", from, to);
  options.extrema_of = {"Y"};
  return options;
}

/// The branch of forced vibrations, with one harmonic or more.
template <class Problem>
continuation::Branch trace_over_eta(const Problem& problem, double preload, double from, double to) {
  return continuation::trace(problem, problem.guess(from, preload), over_eta(from, to));
}

/// The observables at a point.
template <class Problem>
Vector values_at(const Problem& problem, const continuation::BranchPoint& point) {
  Vector values;
  problem.observe(point.unknowns, point.parameters, point.regime, values);
  return values;
}

/// An observable of ForcedResponse at a point.
inline double quantity(const problems::ForcedResponse& problem, const continuation::BranchPoint& point,
                       problems::ForcedResponse::Quantity which) {
  return values_at(problem, point)(which);
}

}  // namespace arcslip::testing
