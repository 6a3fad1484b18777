#pragma once

// The slope of a smooth element's force as its motion passes, all that small disturbances see of it:
//
//   df = k(theta) dx,   k(theta) = Re sum_m k_m e^{2jm theta},   m = 0, 1, 2, ...,
//
// since an odd force under an odd motion has the same slope half a period later.

#include <vector>

#include "arcslip/types.hpp"

namespace arcslip {

/// k(theta) by its Fourier coefficients.
struct VaryingStiffness {
  std::vector<Complex> harmonics;  ///< k_m; the first is real

  /// k(theta).
  double at(double theta) const;

  /// t_m of k(theta + width s) = sum_m t_m s^m.
  double term(double theta, double width, Index m) const;

  /// c_n of k = sum_n c_n e^{jn theta}, for any n.
  Complex coefficient(int n) const;

  /// Whether nothing but c_0 is there.
  bool is_constant() const { return harmonics.size() <= 1; }
};

}  // namespace arcslip
