#pragma once

// The slope of an element's force without memory as its motion passes, all that small disturbances see of it:
//
//   df = k(theta) dx,   k(theta) = Re sum_m k_m e^{2jm theta},   m = 0, 1, 2, ...,
//
// since an odd force under an odd motion has the same slope half a period later; where the law changes with
// the displacement, on each arc of half a period by harmonics of its own, Re sum_m k_m e^{jm theta} on the
// first of its repetitions.

#include <vector>

#include "arcslip/types.hpp"

namespace arcslip {

/// k(theta) by its Fourier coefficients.
struct VaryingStiffness {
  /// Where one piece of the law holds.
  struct Arc {
    double begin;                    ///< theta
    double width;                    ///< the same
    std::vector<Complex> harmonics;  ///< k_m; the first is real
  };

  std::vector<Complex> harmonics = {};  ///< k_m; the first is real; with arcs none
  std::vector<Arc> arcs = {};           ///< one after the other, if there are any, over half a period

  /// k(theta).
  double at(double theta) const { return term(theta, 0, 0); }

  /// t_m of k(theta + width s) = sum_m t_m s^m, by the law in the middle of the width.
  double term(double theta, double width, Index m) const;

  /// c_n of k = sum_n c_n e^{jn theta}, for any n.
  Complex coefficient(int n) const;

  /// What |k| does not exceed.
  double bound() const;

  /// Whether nothing but c_0 is there.
  bool is_constant() const { return harmonics.size() <= 1 && arcs.empty(); }
};

}  // namespace arcslip
