#pragma once

// All that small disturbances of a response see of an element: when a contact sticks, or the stiffness of a
// smooth element as its motion passes, or any law.

#include <algorithm>
#include <span>
#include <vector>

#include "arcslip/elements/disturbed_law.hpp"
#include "arcslip/elements/hysteresis_loop.hpp"
#include "arcslip/elements/varying_stiffness.hpp"

namespace arcslip {

/// Of one element, over half a period or, where only `law` tells it, over a turn.
struct StickPattern {
  bool slips = false;  ///< else it sticks all the time
  /// Of stick, in half a period; one at least where it slips. Between two there is slip: a gap of 1e-9 at
  /// least, for sliders rest over no longer a time than one arc lasts.
  std::vector<HysteresisLoop::Arc> arcs = {};
  VaryingStiffness stiffness = {};  ///< of a smooth element; of a contact that sticks empty, for its spring
  /// In place of all this, over a turn; without pieces it is not given.
  DisturbedLaw law = {};
  /// f_h at h = 0, 1, ..., of each of its coordinates, in a motion that no load drives, whose phase is free:
  /// its velocity is a disturbance that lasts, and left out. Else empty.
  std::vector<ComplexVector> free_force = {};
};

/// Whether any element is told by its law alone.
inline bool has_law(std::span<const StickPattern> elements) {
  return std::any_of(elements.begin(), elements.end(),
                     [](const StickPattern& one) { return !one.law.pieces.empty(); });
}

/// The law of an element: of a contact of stiffness `spring` or, below 0, of another one.
DisturbedLaw law_of(const StickPattern& element, double spring);

/// Of a contact whose motion has these harmonics.
StickPattern stick_pattern(std::span<const int> orders, const HarmonicVector& motion, double slip_threshold,
                           bool slips);

}  // namespace arcslip
