#include "arcslip/time/ring_stability.hpp"

#include <algorithm>
#include <cmath>

#include "arcslip/structure/spectrum.hpp"

namespace arcslip {
double RingStability::growth() const { return std::pow(std::abs(turned(0)), periods); }

Index RingStability::unstable(double margin) const {
  return std::count_if(turned.begin(), turned.end(), [&](const Complex& multiplier) {
    return std::pow(std::abs(multiplier), periods) > 1 + margin;
  });
}

RingStability floquet_stability(RingMotion& motion, const RingState& state) {
  const Ring& ring = motion.ring();
  const Index coordinates = ring.coordinates();
  const long before = motion.count().events;
  Matrix derivative = next_derivative(motion, state).derivative;
  derivative.middleRows(coordinates, coordinates) /= motion.frequency();
  derivative.middleCols(coordinates, coordinates) *= motion.frequency();

  RingStability stability;
  stability.periods = static_cast<double>(ring.nodes()) / static_cast<double>(ring.wave_number);
  stability.slips = motion.count().events > before ||
                    std::any_of(state.slip.begin(), state.slip.end(), [](int sign) { return sign != 0; });
  if (!stability.slips) {
    stability.turned = spectrum(Matrix(derivative.topLeftCorner(2 * coordinates, 2 * coordinates)));
  } else {
    stability.turned = spectrum(ring.drift ? deflated(derivative, Matrix(neutral_drift(ring))) : derivative);
  }
  return stability;
}

Matrix monodromy(RingMotion& motion, const RingState& state) {
  RingTangent tangent(motion);
  RingState end = state;
  motion.advance(end, motion.period(), &tangent);
  Matrix derivative = tangent.at(end);
  const Index coordinates = motion.ring().coordinates();
  for (Index i = 0; i < motion.ring().nodes(); ++i) {
    if (state.slip[i] != 0) derivative.col(2 * coordinates + i).setZero();
  }
  return derivative;
}

}  // namespace arcslip
