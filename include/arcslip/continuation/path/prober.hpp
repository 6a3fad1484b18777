#pragma once

// The branch within a step, solved for at any place of it.

#include <optional>
#include <vector>

#include "arcslip/continuation/path/corrector.hpp"
#include "arcslip/continuation/path/monitors.hpp"

namespace arcslip::continuation {

/// What was found at a place of a step.
struct Probe {
  CurvePoint point;               ///< of the branch
  Vector slope;                   ///< n + 1: d(z/scale)/ds
  std::vector<Monitor> monitors;  ///< as those of the step
  /// Change of the parameter over s.
  double parameter_rate() const { return slope(slope.size() - 1); }
};

/// Keeps references to all that it is made of.
class Prober {
 public:
  /// Of the step, whatever it becomes.
  Prober(Corrector& corrector, Monitors& monitors, Step& step);

  /// The branch at 0 <= s <= distance, solved to rounding; the ends and the branch point in the step are
  /// known already. False if that fails.
  [[nodiscard]] bool probe(double s);
  /// What was found at the place last probed.
  const Probe& probed() const { return probed_; }

  /// Goes a little way along the tangent from the point last probed, within the step and no less than asked
  /// for: returns how far in s, or 0 if nothing can be evaluated there.
  double look_beside(double least = 0);
  /// What was found at the place beside it.
  const Probe& beside() const { return beside_; }

  /// Factors the problem at this offset in s from a point of the step with this slope.
  Correction linearise_beside(const CurvePoint& point, const Vector& slope, double offset);

  /// How far beside a point in s slopes are taken: as near as the rounding of the parameter lets them be
  /// told.
  double offset_beside(double s) const;

  /// Keeps the point last probed, from which others are found.
  void anchor();

  /// Whether a point of the branch's past lies within the step, passed in the same direction; the step then
  /// ends there if `cut` is called with the value probed.
  [[nodiscard]] std::optional<double> passes(const CurvePoint& past, double same);

  /// Ends the step at the point last probed.
  void cut();

 private:
  Corrector& corrector_;
  Monitors& monitors_;
  Step& step_;
  Probe probed_;
  Probe beside_;
  double s_ = 0;           // of the place last probed
  bool is_known_ = false;  // an end of the step or the branch point in it
  long when_ = -1;  // the corrector's evaluations when it was done; it stands as long as there are no others
  Vector work_;
  Vector way_;
};

}  // namespace arcslip::continuation
