#pragma once

// Points of a branch solved anew, with more harmonics and, where the ring can be assembled, by integrating
// all its nodes in time, so that a branch says itself how far it can be trusted.

#include <functional>
#include <limits>
#include <optional>
#include <vector>

#include "arcslip/assembly/system.hpp"
#include "arcslip/continuation/path/branch.hpp"
#include "arcslip/problems/response/harmonic_response.hpp"
#include "arcslip/problems/tasks/offset_bounds.hpp"
#include "arcslip/time/ring_motion.hpp"

namespace arcslip::problems {

/// Invariants of a response that its equations do not hold by themselves, but where they are solved.
struct BalanceErrors {
  double power = 0;         ///< of PowerBalance
  double cancellation = 0;  ///< of PowerBalance
  double motion = 0;        ///< motion_error
};

/// The largest at the points of a branch, which is one of HarmonicResponse, or of its scalar forms, with the
/// system of `parameters` in `orders`. None where `go_on`, asked before each point, says no.
std::optional<BalanceErrors> largest_errors(const SystemParameters& parameters,
                                            const std::vector<int>& orders,
                                            const continuation::Branch& branch,
                                            const std::function<bool()>& go_on = {});

/// What the elements of the first node do in a response, harmonic by harmonic: what the ring in time is begun
/// with.
std::vector<RingHarmonic> ring_harmonics(const HarmonicResponse& problem, const continuation::Guess& at);

/// NaN where a method has no result.
struct Verification {
  std::size_t point;   ///< of the branch
  double Y;            ///< first harmonic, as traced
  double power_error;  ///< of PowerBalance
  int highest;         ///< harmonic of the second solution
  double Y_harmonics;  ///< of the second solution
  double Y_time;       ///< by time integration
  double growth;       ///< of the worst disturbance in a period, |mu|: stable below 1; by time integration

  std::optional<OffsetBounds> offsets = {};  ///< where contacts stick for ever
};

/// Which points are solved anew, and by what means.
struct VerifyOptions {
  std::size_t samples = 10;  ///< regular points, spread over the branch, besides the special ones
  /// Special points, the first ones; only these are integrated in time.
  std::size_t most_special = std::numeric_limits<std::size_t>::max();
  bool in_time = true;  ///< whether to integrate in time, some seconds for a point of 30 nodes

  /// Called before each point with its number among those chosen and how many these are; false ends it.
  std::function<bool(std::size_t, std::size_t)> progress = {};
  std::function<void(const Verification&)> found = {};  ///< called with each result as soon as it is there
  std::function<void(const std::string&)> refused =
      {};  ///< called at the end where something was not found in time: why
};

/// Solves special points of such a branch, and some others, anew.
std::vector<Verification> verify(const SystemParameters& parameters, const std::vector<int>& orders,
                                 const continuation::Branch& branch, const VerifyOptions& options = {});

}  // namespace arcslip::problems
