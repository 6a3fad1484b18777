#pragma once

// All limit cycles at one zeta_B. There 1 + k phi(R/S) c(eta) = 0 says that
//
//   z(eta) = -1/(k c(eta; zeta_B))   lies on the curve   phi(R/S),  Im phi = 4/pi x (1 - x),  x = S/R,
//
// an arc from 1, in stick, to 0, for ever larger cycles: one equation in eta, over the stretches where Re z
// is between 0 and 1.

#include <vector>

#include "arcslip/assembly/system.hpp"

namespace arcslip::problems {

/// A cycle, whatever the preload is.
struct CycleAtZeta {
  double eta;        ///< its frequency
  double log_ratio;  ///< ln(R/S)
  bool is_small;     ///< -zeta_B rises with R along its family
};

/// In the order of eta. Two on one stretch that are about to meet in a fold may be missed.
std::vector<CycleAtZeta> cycles_at(const FrictionSystem& system, double zeta);

}  // namespace arcslip::problems
