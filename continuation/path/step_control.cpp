#include "arcslip/continuation/path/step_control.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace arcslip::continuation {

namespace {

/// Down to a power of 2^(1/32): differences that are small would tell by their rounding where points lie.
double rounded(double factor) { return std::exp2(std::floor(32 * std::log2(factor)) / 32); }

}  // namespace

bool acceptable(const StepSignals& signals, const StepLimits& limits, double max_step) {
  return signals.contraction <= limits.contraction_limit && signals.turn <= limits.turn_limit &&
         signals.prediction_error <= limits.error_limit * max_step &&
         signals.mismatch <= limits.mismatch_limit * max_step && signals.roughness <= 1;
}

double step_factor(const StepSignals& signals, const StepLimits& limits, double max_step) {
  constexpr double tiny = std::numeric_limits<double>::min();
  const double factor = std::min(
      {std::sqrt(limits.contraction_aim / (signals.contraction + tiny)),
       limits.turn_aim / (signals.turn + tiny), rounded(limits.roughness_aim / (signals.roughness + tiny)),
       std::sqrt(limits.error_aim * max_step / (signals.prediction_error + tiny))});
  const double largest = acceptable(signals, limits, max_step) ? limits.growth
                         : signals.roughness > 1               ? limits.roughness_aim
                                                               : 0.5;
  return std::clamp(factor, limits.shrink, largest);
}

}  // namespace arcslip::continuation
