#pragma once

// Steps along a branch within one regime: prediction, correction, and the tests that a step must pass before
// it counts. The condition that closes the step is either the tangent's (pseudo-arclength, which passes
// folds) or the parameter's (which passes the tip of a needle-sharp peak, where the plane normal to a
// vertical tangent misses the branch, and lands on values); the caller turns to the other when one fails.

#include <functional>
#include <vector>

#include "arcslip/continuation/events/crossing.hpp"
#include "arcslip/continuation/path/one_curve.hpp"
#include "arcslip/continuation/path/predictor.hpp"
#include "arcslip/continuation/path/step_control.hpp"

namespace arcslip::continuation {

/// Attempts steps along the branch: predicts, corrects, and says whether what lies between was seen. The
/// problem and the corrector are kept by reference.
class Stepper {
 public:
  /// `tracked` are the observables whose extrema are looked for; a step is kept only if it resolves them.
  /// Without `pairs` no two branch points are looked for that one step may pass; `rough_extrema` are not
  /// located within it. Where F `may_bend`, continuous at corners, the determinant may jump to its other
  /// sign.
  Stepper(const Problem& problem, Corrector& corrector, std::vector<Index> tracked, double max_step,
          bool pairs = true, const Tolerances& tolerances = {}, bool rough_extrema = false,
          bool may_bend = true);
  Stepper(const Stepper&) = delete;
  Stepper& operator=(const Stepper&) = delete;

  /// By which it judges.
  const Tolerances& tolerances() const { return tolerances_; }
  /// Whether extrema lie where the slopes at both ends of a step tell.
  bool has_rough_extrema() const { return rough_extrema_; }
  /// On the residual.
  double tolerance() const { return corrector_.options().tolerance; }

  /// That last attempted; where it begins the branch stands.
  const Step& step() const { return step_; }
  const CurvePoint& here() const { return step_.here; }
  const Monitors& monitors() const { return monitors_; }
  /// Solves for the branch within the step.
  Prober& prober() { return prober_; }

  /// Tells where the branch comes near to branches with more symmetries. Observables, as the greatest of what
  /// is equal there, may have a corner: no step has to resolve them.
  void set_meeting(std::function<bool(const CurvePoint&)> meets) { meets_ = std::move(meets); }
  /// Whether the step begins or ends there.
  bool is_near_meeting() const { return meets_ && (meets_(step_.here) || meets_(step_.there)); }

  /// Whether `here` is a value that was landed on, where a feature of the branch may be so narrow that it is
  /// seen by its slopes alone: unknowns count in the steps from and to it.
  void set_on_target(bool on_target) { on_target_ = on_target; }

  /// Starts from a guess, keeping its parameters; `forward` is the wanted sign of the parameter's change.
  Correction start(const Vector& unknowns, const Vector& parameters, const Regime& regime, double forward);

  /// Starts at a point along a direction, n + 1 of (u, p_a). A point that already solves the problem stays
  /// as it is, so that the start may be a branch point.
  Correction start_along(const Vector& unknowns, const Vector& parameters, const Regime& regime,
                         const Vector& direction);

  /// Whether a start from a guess is a fold or a branch point, where the parameter cannot be kept.
  bool starts_singular() { return !is_regular() && crossings_.starts_singular(max_step_); }

  /// Looks a little way ahead along the tangent, for the prober's `beside`; false where nothing can be
  /// evaluated there.
  [[nodiscard]] bool look_ahead(double way);

  /// Puts back what a checkpoint holds.
  void restore(const Progress& progress);
  /// What a checkpoint takes: how the last steps bend, and monitors at `here`, their slopes along the
  /// unit tangent.
  const Bends& bends() const { return predictor_.bends(); }
  const std::vector<Monitor>& at_here() const { return at_here_; }

  /// Whether the problem has been scaled anew since its determinants were taken.
  bool is_rescaled() const { return revision_ != problem_.revision(); }

  /// Goes into `regime` at the border where the point `here` lies: the tangent of the new piece, oriented
  /// into it.
  Correction enter(const Regime& regime);

  /// Forgets how the branch bends, which behind a corner tells nothing; false if nothing is known.
  [[nodiscard]] bool straighten();

  /// Goes past a corner within the regime, just ahead, that no step passes, whatever the angle.
  /// False, and still at `here`, if there is none.
  [[nodiscard]] bool pass_corner();

  /// Whether in this regime there are neither folds nor branch points.
  bool is_regular() const { return problem_.is_regular(step_.here.regime); }

  /// Whether from `here` on the unknowns are linear functions' and lengths those of the parameter.
  bool is_over_parameter() const { return corrector_.is_over_parameter(step_.here.regime); }

  /// Arclength per distance at `here`: 1 or more.
  double slope_length(Hold hold) const;

  /// Change of the parameter, in its scale, per distance at `here`.
  double parameter_slope(Hold hold) const;

  /// Tries a step of the given distance; true if it is kept.
  [[nodiscard]] bool attempt(Hold hold, double distance);

  /// Tries to land on a value of the parameter ahead.
  [[nodiscard]] bool attempt_landing(double value);

  /// Of the last attempt, and why it was not kept, where the corrector failed.
  const StepSignals& signals() const { return signals_; }
  Correction last_correction() const { return last_correction_; }

  /// How much of what a step may leave open is between `here` and s, by the monitors' values and slopes
  /// there: above 1 there may be more in between than these tell.
  double roughness(double s, const std::vector<Monitor>& at_s) const;

  /// Moves the step's end, which is next to it, onto a border of its regime, and thereby to the parameter's
  /// last bit off the branch rather than off the border: beyond it the residual may be 10^5 times as
  /// sensitive.
  void settle_on_border(int border);

  /// Makes the step's end the new `here`.
  void advance();

 private:
  void begin_piece(const CurvePoint& origin);
  void set_moved(double before);  // from this value of the parameter
  void set_condition(Hold hold);
  void predict();
  [[nodiscard]] bool finish(bool lands, double value);
  [[nodiscard]] bool knows_crossings(bool corner);
  bool turns_at_once() const;
  bool goes_on();
  bool finds(const CurvePoint& from, const Vector& along, double distance, double orientation);
  bool ends_singular() const;

  const Problem& problem_;
  Corrector& corrector_;
  Tolerances tolerances_;
  double max_step_;
  bool pairs_;
  bool rough_extrema_;  // of branch points are looked for
  bool may_bend_;
  StepLimits limits_;
  Step step_;
  Monitors monitors_;
  Prober prober_;
  CrossingSearch crossings_;
  OneCurve one_curve_;
  Predictor predictor_;
  std::function<bool(const CurvePoint&)> meets_;
  std::vector<Monitor> at_here_;
  Vector work_;
  CurvePoint aside_;
  StepSignals signals_;
  Correction last_correction_ = Correction::converged;
  bool on_target_ = false;
  long revision_ = 0;  // of the problem's scaling that determinants belong to
};

}  // namespace arcslip::continuation
