#pragma once

// The case problems/flutter.toml and its kin, and their nodes without anything of the program's.

#include <fmt/format.h>

#include <string>
#include <vector>

#include "case_runs.hpp"

namespace arcslip::testing {

/// Settings of the case with these waves and the force g (d_{i-1} - d_{i+1}).
inline Settings flutter_of(double g, const std::string& waves) {
  return {fmt::format("flutter.coefficients=[[-1, {0:.17g}], [1, -{0:.17g}]]", g),
          fmt::format("branch.for_each.wave_number=[{}]", waves)};
}

/// The same of one wave in the odd harmonics up to a highest one.
inline SystemParameters flutter_system(double g, Index wave, int highest, const Settings& more = {}) {
  Settings settings = flutter_of(g, fmt::format("{}", wave));
  settings.push_back(fmt::format("system.harmonics={}", highest));
  settings.push_back(fmt::format("system.wave_number={}", wave));
  settings.insert(settings.end(), more.begin(), more.end());
  return read_case(source_folder() + "/problems/flutter.toml", settings).branches.front().problem.system;
}

/// A mass on each of N nodes under forces of neighbours, as K - L, row by row: 1 to ground, 0.05 to the next.
inline Matrix nodes_in_flow(Index nodes, const std::vector<Influence::Coefficient>& coefficients) {
  Matrix stiffness = Matrix::Zero(nodes, nodes);
  for (Index i = 0; i < nodes; ++i) {
    const auto at = [&](Index offset) -> double& {
      return stiffness(i, ((i + offset) % nodes + nodes) % nodes);
    };
    at(0) += 1.1;
    at(1) -= 0.05;
    at(-1) -= 0.05;
    for (const auto& [neighbour, value] : coefficients) at(neighbour) -= value.real();
  }
  return stiffness;
}

}  // namespace arcslip::testing
