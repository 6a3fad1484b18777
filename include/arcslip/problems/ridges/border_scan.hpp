#pragma once

// What happens along the border of stick, where R = S on the stuck response at P = P_border(eta). Three
// slopes over eta are known in closed form there:
//
//   d ln Y/d eta      of the stuck response, zero at its peaks and troughs
//   d ln Y/d eta      of the slipping one, zero where a ridge dY/d eta = 0 in slip meets the border
//   d ln(R/S)/d eta   of the stuck one, zero where P_border turns

#include <vector>

#include "arcslip/assembly/system.hpp"

namespace arcslip::problems {

/// A place along the border, at P_border(eta).
struct BorderPlace {
  double eta;               ///< where it is
  bool is_mark = false;     ///< given as one, or a zero of a slope
  bool is_peak = false;     ///< of the stuck Y
  bool is_meeting = false;  ///< of the border with a ridge in slip
};

/// Places along the border with eta rising: those given and the marks, as many between that the slopes do
/// what those of neighbours tell, and the zeros.
std::vector<BorderPlace> scan_border(const FrictionSystem& system, std::vector<double> etas,
                                     const std::vector<double>& marks);

}  // namespace arcslip::problems
