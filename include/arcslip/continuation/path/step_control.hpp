#pragma once

// The length of the steps, from four signals: how fast the corrector contracted, how far the tangent turned,
// how far the point lies from where the last step's curvature leads, and how rough what is watched is between
// the ends. Near a smooth branch each grows at least as the square of the step (the turn and the roughness:
// as the step), so that each asks for a factor sqrt(aim/signal) (these: aim/signal).

namespace arcslip::continuation {

/// Of one attempt.
struct StepSignals {
  double contraction = 0;       ///< |dz_2|/|dz_1| of Newton's method
  double turn = 0;              ///< angle between the tangents, radians
  double prediction_error = 0;  ///< |point - end of a parabola| in the problem's scale
  double mismatch =
      0;  ///< |step - (mean of the end slopes) x distance|: a branch in between that is not smooth
  double roughness = 0;  ///< of what is watched along the step, of what it may be
};

/// The signals that steps aim at, and those beyond which they are not kept.
struct StepLimits {
  /// Of Newton's method, and of the angle in radians.
  double contraction_aim = 0.2;
  double contraction_limit = 0.6;
  double turn_aim = 0.25;
  double turn_limit = 0.6;
  double error_aim = 0.05;      ///< of the largest step
  double error_limit = 0.25;    ///< of the largest step
  double mismatch_limit = 0.1;  ///< of the largest step
  double roughness_aim = 0.8;   ///< steps are not kept above 1
  double growth = 2;            ///< largest factor after a good step
  double shrink = 0.2;          ///< smallest factor
};

/// Whether a step with these signals is kept.
bool acceptable(const StepSignals& signals, const StepLimits& limits, double max_step);

/// Factor on the next step; below 1 after a step that is not acceptable.
double step_factor(const StepSignals& signals, const StepLimits& limits, double max_step);

}  // namespace arcslip::continuation
