#pragma once

// Which wave round the ring a disturbance mostly is.

#include <vector>

#include "arcslip/types.hpp"

namespace arcslip {

/// Where one oscillator stands in an eigenvector: its displacement at `position`, its velocity over `scale`
/// at `velocity`; of a real motion their imaginary parts behind, which also are those of the conjugate wave.
struct WavePlace {
  Index wave;        ///< of 0 .. N - 1
  double frequency;  ///< of the oscillator, in units of eta
  double scale;      ///< > 0
  Index position;    ///< in the vector
  Index velocity;    ///< in the vector
  bool is_real;      ///< whether imaginary parts stand behind
};

/// The wave that has most of the energy of `vector`, of 0 .. N - 1: that is, e^{j(wt - 2 pi wave i/N)} with
/// w > 0, so that waves below N/2 run as node numbers do. Of what stands still, the one up to N/2.
Index disturbed_wave(const std::vector<WavePlace>& places, const ComplexVector& vector, Index nodes);

}  // namespace arcslip
