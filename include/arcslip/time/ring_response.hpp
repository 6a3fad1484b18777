#pragma once

// The settled response of a ring to its travelling load. Each node repeats the one before it with the delay
// nT/N, so the response is a fixed point of
//
//   G(s) = turn(flow(s, nT/N)),   turn: node i takes the place of node i + 1
//
// that a march reaches from rest, or Newton's method with the derivative of the flow (ring_tangent.hpp).
// Where all nodes do the same at once, n = 0, G is the flow over a period.
//
// Rigid motions are neutral that no structure and no element resists: sliders go with them, and r - x stays
// as it was, as with base against damper of two free rings. Responses that differ by such a drift are one
// here.

#include "arcslip/time/ring_tangent.hpp"

namespace arcslip {

/// G(s); its time is that of s.
RingState next_state(RingMotion& motion, const RingState& state, RingObserver* observer = nullptr);

/// dG/ds, (2D + M) x (2D + M), with G(s).
struct StateDerivative {
  RingState next;           ///< G(s)
  Matrix derivative;        ///< dG/ds
  std::vector<bool> moved;  ///< RingTangent::moved
};
StateDerivative next_derivative(RingMotion& motion, const RingState& state);

/// Unit vectors of neutral drifts in (position, velocity, memory), (2D + M) x their number: those that are
/// the same at all nodes or, of `any_wave`, others as well. Elements that have not `moved` hold what they
/// feel.
Matrix neutral_drifts(const RingMotion& motion, bool any_wave = false, const std::vector<bool>& moved = {});

/// |a - b| over |b| in (position, velocity/w*, memory), each without its part along drifts.
double state_distance(const RingMotion& motion, const RingState& a, const RingState& b);

/// A response that repeats itself.
struct [[nodiscard]] SettledMotion {
  RingState state;  ///< s
  double error;     ///< |G(s) - s| over |s|, this without its part along drifts
  int rounds;       ///< of the march, each nT/N long, or of Newton's method
  bool settled;     ///< whether the tolerance is met
};

/// Marches until the state repeats within `tolerance`, for at most `rounds` of nT/N. Where contacts come to
/// stick for good, their sliders stay as the start has left them, not the same at each node: such a motion is
/// periodic, but no travelling wave, and is never settled in this sense.
SettledMotion march_until_settled(RingMotion& motion, RingState state, double tolerance, int rounds);

/// Newton's method on G(s) = s from a guess, with a derivative that is kept while steps with it do well.
/// Steps are halved while they do not bring G(s) nearer to s; where none does, the ring is marched for n
/// periods, which may lead away from an unstable response. Memory of elements that never change their phase
/// is made the same at all nodes.
SettledMotion shoot(RingMotion& motion, RingState guess, double tolerance = 1e-12, int rounds = 40);

}  // namespace arcslip
