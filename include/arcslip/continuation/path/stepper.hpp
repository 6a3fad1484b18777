#pragma once

// One step along a branch within one regime: prediction, correction, and the tests that the step must pass
// before it counts. The condition that closes the step is either the tangent's (pseudo-arclength, which
// passes folds) or the parameter's (which passes the tip of a needle-sharp peak, where the plane normal to a
// vertical tangent misses the branch, and lands on values); the caller turns to the other when one fails.

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "arcslip/continuation/events/first_zero.hpp"
#include "arcslip/continuation/events/remote_zero.hpp"
#include "arcslip/continuation/path/checkpoint.hpp"
#include "arcslip/continuation/path/corrector.hpp"
#include "arcslip/continuation/path/step_control.hpp"
#include "arcslip/continuation/path/tolerances.hpp"

namespace arcslip::continuation {

/// Attempts steps along the branch: predicts, corrects, and says whether what lies between was seen. The
/// problem and the corrector are kept by reference.
class Stepper {
 public:
  /// `tracked` are the observables whose extrema are looked for; a step is kept only if it resolves them.
  /// Without `pairs` no two branch points are looked for that one step may pass.
  Stepper(const Problem& problem, Corrector& corrector, std::vector<Index> tracked, double max_step,
          bool pairs = true, const Tolerances& tolerances = {});

  const Tolerances& tolerances() const { return tolerances_; }

  /// Where the step begins, and its end once it is kept.
  const CurvePoint& here() const { return here_; }
  const CurvePoint& there() const { return there_; }

  /// Starts from a guess, keeping its parameters; `forward` is the wanted sign of the parameter's change.
  Correction start(const Vector& unknowns, const Vector& parameters, const Regime& regime, double forward);

  /// Starts at a point along a direction, n + 1 of (u, p_a). A point that already solves the problem stays
  /// as it is, so that the start may be a branch point.
  Correction start_along(const Vector& unknowns, const Vector& parameters, const Regime& regime,
                         const Vector& direction);

  /// Puts back what a checkpoint holds.
  void restore(const Progress& progress);
  /// What a checkpoint takes: the curvature of the last step, and the points before `here`, the last one
  /// first.
  const Vector& bend() const { return bend_; }
  const std::vector<PastPoint>& past() const { return past_; }

  /// Why the last attempt was not kept, where the corrector failed.
  Correction last_correction() const { return last_correction_; }

  /// Goes into `regime` at the border where the point `here` lies: the tangent of the new piece, oriented
  /// into it.
  Correction enter(const Regime& regime);

  /// Goes past a corner within the regime, just ahead, at which the branch turns by more than a right angle.
  /// False, and still at `here`, if there is none.
  [[nodiscard]] bool turn_back();

  /// Arclength per distance at `here`: 1 or more.
  double slope_length(Hold hold) const;

  /// Change of the parameter, in its scale, per distance at `here`.
  double parameter_slope(Hold hold) const;

  /// Tries a step of the given distance; true if it is kept, in `there`.
  [[nodiscard]] bool attempt(Hold hold, double distance);

  /// Tries to land on a value of the parameter ahead.
  [[nodiscard]] bool attempt_landing(double value);

  /// Of the last attempt: its signals, the tolerance on F, the step's length along the tangent, and the
  /// chord's in the scale.
  const StepSignals& signals() const { return signals_; }
  double tolerance() const { return corrector_.options().tolerance; }
  double distance() const { return distance_; }
  double chord() const { return step_.norm(); }

  /// Monitors at `here`, their slopes along the unit tangent: the tracked observables first, then the
  /// borders.
  const std::vector<Monitor>& at_here() const { return at_here_; }

  /// Monitors at both ends of the step.
  const std::vector<Monitor>& from() const { return from_; }
  const std::vector<Monitor>& to() const { return to_; }
  const std::vector<Index>& tracked() const { return tracked_; }
  Index tracked_count() const { return static_cast<Index>(tracked_.size()); }

  /// What changes of a tracked observable are measured in, where it has this value.
  double size_of(std::size_t observable, double value) const {
    return std::max(observed_[observable].scale, std::abs(value));
  }

  /// Change of the parameter over the step's coordinate at both ends.
  double parameter_rate_from() const { return slope_from_(slope_from_.size() - 1); }
  double parameter_rate_to() const { return slope_to_(slope_to_.size() - 1); }

  /// Where the parameter may turn twice within the step although it runs the same way at both ends.
  bool may_turn_twice() const;

  /// The branch at 0 <= s <= distance within the step, solved to rounding; its ends and the branch point in
  /// it are known already. False if that fails.
  [[nodiscard]] bool probe(double s);
  /// What was found at the place last probed.
  const std::vector<Monitor>& probed() const { return probed_; }
  const CurvePoint& probed_point() const { return probe_; }
  double probed_parameter_rate() const { return probe_slope_(probe_slope_.size() - 1); }

  /// Goes a little way along the tangent from the point last probed, within the step: returns how far in s,
  /// or 0 if nothing can be evaluated there.
  double look_beside();
  /// What was found at the place beside it.
  const CurvePoint& beside_point() const { return beside_; }
  const std::vector<Monitor>& beside_monitors() const { return at_beside_; }
  double beside_parameter_rate() const { return beside_rate_; }

  /// Whether the monitors' values and slopes at `here` and at s fit a curve without more in between.
  bool resolved(double s, const std::vector<Monitor>& at_s) const;

  /// Whether the step is so short that what is still unlike a smooth curve is rounding, or a corner.
  bool is_least() const { return is_tiny(distance_); }

  /// Ends the step at the point last probed.
  void cut();

  /// Moves `there`, which is next to it, onto a border of its regime, and thereby to the parameter's last bit
  /// off the branch rather than off the border: beyond it the residual may be 10^5 times as sensitive.
  void settle_on_border(int border);

  /// The first branch point within the step, if the step passes one.
  struct Crossing {
    double s = 0;            ///< where in the step
    CurvePoint point;        ///< located to rounding
    Vector slope;            ///< n + 1, of the branch in s
    double rate_behind = 0;  ///< of the parameter
  };
  /// Of the step last attempted; none where no branch point was passed.
  const std::optional<Crossing>& crossing() const { return crossing_; }

  /// Whether a point of the branch's past lies within the step, passed in the same direction; the step then
  /// ends there if `cut` is called with the value.
  [[nodiscard]] std::optional<double> passes(const CurvePoint& past);

  /// Makes `there` the new `here`.
  void advance();

 private:
  void begin_piece(const CurvePoint& origin);
  void interpolate(double s, Vector& out) const;
  bool starts_singular();
  void rescale_determinant();
  bool may_cross() const;
  [[nodiscard]] bool search_crossing();
  std::optional<Node> determinant_at(double s);
  double beside(double s) const;
  Correction linearise_beside(const CurvePoint& point, const Vector& slope, double offset);
  [[nodiscard]] bool probe_between(double s);
  void anchor(double s);
  [[nodiscard]] bool narrow(Node& before, Node& behind, double& s, double radius);
  [[nodiscard]] bool locate_crossing(Node before, Node behind);
  [[nodiscard]] bool take_crossing(const RemoteZero& zero, double sign_behind);
  void remember();
  void scale_gradient(const Vector& scale, Vector& out) const;  // of gradient_
  bool is_tiny(double s) const;
  double rate_at(const CurvePoint& point) const;  // of the parameter over arclength
  double arc_rate() const;                        // arclength per distance at there_
  void set_condition(Hold hold);
  void predict();
  bool finish(bool lands, double value);
  void monitor(const CurvePoint& point, const Vector& scale, const Vector& slope, std::vector<Monitor>& out);
  void bend_along(Vector& out) const;

  /// A point of the branch within the step, relative to `here`.
  struct Anchor {
    double s;
    Vector place;
    Vector slope;
  };

  const Problem& problem_;
  Corrector& corrector_;
  std::vector<Index> tracked_;
  std::vector<Observable> observed_;  // those tracked
  double max_step_;
  bool pairs_;  // of branch points are looked for
  Tolerances tolerances_;
  StepLimits limits_;

  CurvePoint here_;
  CurvePoint there_;
  CurvePoint probe_;
  Hold hold_ = Hold::tangent;
  double distance_ = 0;
  Vector normal_;
  Vector slope_from_;
  Vector slope_to_;
  Vector probe_slope_;
  Vector predicted_;
  Vector step_;
  Vector work_;
  Vector bend_;  // d^2 z/ds^2 over the last step, along the arc, in here_'s scale
  Vector next_bend_;
  StepSignals signals_;
  Correction last_correction_ = Correction::converged;
  std::optional<Crossing> crossing_;
  std::vector<PastPoint> past_;  // the last one first
  long revision_ = 0;            // of the problem's scaling that these belong to
  std::vector<Anchor> anchors_;  // by s
  struct {
    double here, there, unit;  // logarithms of det [J F_p; normal^T] at both ends, and what it is measured in
    bool from_zero;            // the step starts on a branch point
  } determinant_{};
  Vector expected_;
  std::vector<Monitor> at_here_;  // with slopes along the unit tangent
  std::vector<Monitor> from_;
  std::vector<Monitor> to_;
  std::vector<Monitor> probed_;
  CurvePoint beside_;
  std::vector<Monitor> at_beside_;
  double beside_rate_ = 0;
  double probed_s_ = 0;
  bool probe_is_known_ = false;  // an end of the step or the branch point in it
  long probed_when_ =
      -1;  // the corrector's evaluations when it was done; it stands as long as there are no others
  Gradient gradient_;
};

}  // namespace arcslip::continuation
