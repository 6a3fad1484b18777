#pragma once

// The settled response of a ring to its travelling load. Each node repeats the one before it with the delay
// nT/N, so the response is a fixed point of
//
//   G(s) = turn(flow(s, nT/N)),   turn: node i takes the place of node i + 1
//
// that a march reaches from rest, or Newton's method with the derivative of the flow. Between events the
// derivative obeys the linear ring of the sticking contacts. Friction forces are continuous where stick ends
// and where it begins, so displacements and velocities have no jump in their derivatives either; a slider
// moves with its contact while this slips and is left, when slip ends, where the relative displacement has
// taken it: delta x = delta r, for r' = 0 at that moment whatever its delay.
//
// One direction is neutral in every state: base against damper as rigid bodies, with all sliders. Neither
// structure resists it, and r - x stays as it was. Responses that differ by such a drift are one here. On
// further elements the structure that they hold has none, and the other one, if it is free, has it alone.

#include "arcslip/time/ring_motion.hpp"

namespace arcslip {

/// Derivative of the flow by the initial state, along a motion that it follows.
class RingTangent : public RingObserver {
 public:
  /// Columns: position, velocity and slider of the state at the start, 2D + N.
  explicit RingTangent(const RingMotion& motion);
  void follow(const RingSegment& segment, const RingState& state) override;
  void change(Index contact, const RingState& state) override;

  /// The derivative of position, velocity and slider of `state`, at the end: (2D + N) x (2D + N). Columns of
  /// contacts that slipped at the start are zero: their sliders are no free states.
  Matrix at(const RingState& state) const;

 private:
  Matrix slopes(std::size_t element, const RingSegment& segment, Index order) const;

  const Ring& ring_;
  double rate_;
  Matrix position_;
  Matrix velocity_;
  Matrix slider_;
};

/// G(s); its time is that of s.
RingState next_state(RingMotion& motion, const RingState& state, RingObserver* observer = nullptr);

/// dG/ds, (2D + N) x (2D + N), with G(s).
struct StateDerivative {
  RingState next;     ///< G(s)
  Matrix derivative;  ///< dG/ds
};
StateDerivative next_derivative(RingMotion& motion, const RingState& state);

/// The unit vector of the neutral drift in (position, velocity, slider), 2D + N; zero without one.
Vector neutral_drift(const Ring& ring);

/// |a - b| over |b| in (position, velocity/w*, slider), each without its part along the drift.
double state_distance(const RingMotion& motion, const RingState& a, const RingState& b);

/// A response that repeats itself.
struct [[nodiscard]] SettledMotion {
  RingState state;  ///< s
  double error;     ///< |G(s) - s| over |s|, this without its part along the drift
  int rounds;       ///< of the march, each nT/N long, or of Newton's method
  bool settled;     ///< whether the tolerance is met
};

/// Marches until the state repeats within `tolerance`, for at most `rounds` of nT/N. Where contacts come to
/// stick for good, their sliders stay as the start has left them, not the same at each node: such a motion is
/// periodic, but no travelling wave, and is never settled in this sense.
SettledMotion march_until_settled(RingMotion& motion, RingState state, double tolerance, int rounds);

/// Newton's method on G(s) = s from a guess. Steps are halved while they do not bring G(s) nearer to s; where
/// none does, the ring is marched for n periods, which may lead away from an unstable response.
SettledMotion shoot(RingMotion& motion, RingState guess, double tolerance = 1e-12, int rounds = 40);

}  // namespace arcslip
