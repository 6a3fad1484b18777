#pragma once

// What a branch is watched by beside its monitors: functions without derivatives, eigenvalues, and the signs
// last seen of everything.

#include <optional>
#include <string>
#include <vector>

#include "arcslip/continuation/path/stepper.hpp"
#include "arcslip/continuation/path/trace.hpp"

namespace arcslip::continuation {

/// 1, 0 or -1.
inline int sign_of(double value) { return (value > 0) - (value < 0); }

/// Sign of the parameter's rate along a branch, 0 below rounding of tangents: where the parameter stands
/// still it turns by that alone.
int sign_of_rate(const Stepper& stepper, double rate);

/// Sign of an observable's derivative, 0 below rounding of the observable; `monitor` is its own.
int sign_of_slope(const Stepper& stepper, std::size_t observable, const Monitor& monitor);

/// The functions without derivatives that a branch is watched by: the problem's tests, the user's events, and
/// the eigenvalues.
class Watch {
 public:
  /// Both are kept by reference.
  Watch(const Problem& problem, const std::vector<UserEvent>& events);

  /// Evaluates all of them at a point, the Jacobian of a sparse problem there may be at hand.
  void look(const CurvePoint& point, const std::optional<FactoredJacobian>& jacobian = {});

  const std::vector<double>& functions() const { return functions_; }  ///< tests, events, pieces of events
  const ComplexVector& eigenvalues() const { return eigenvalues_; }    ///< by descending real part, or none
  int unstable() const { return unstable_; }                           ///< -1 without eigenvalues

  long looks() const { return looks_; }      ///< how often it looked
  long spectra() const { return spectra_; }  ///< times that eigenvalues were asked for

  /// Whether there is nothing to look at.
  bool empty() const { return tests_.empty() && events_.empty() && !spectral_; }
  /// What the problem calls zeros of these.
  PointType pair_crossing() const { return problem_.pair_crossing(); }
  PointType real_crossing() const { return problem_.real_crossing(); }
  /// Of the points where a function vanishes, and the user's name of it, empty for the problem's tests.
  PointType type(std::size_t function) const;
  const std::string& label(std::size_t function) const;

  /// Where among the functions stands that which tells on which piece another one is, if there are several.
  std::optional<std::size_t> piece_of(std::size_t function) const;

  /// How many are tests and events, in whose zeros one is interested.
  std::size_t searched() const { return tests_.size() + events_.size(); }

  /// Keeps what was seen last as that of the point that the branch has come to, which lies `chord` behind the
  /// one before.
  void keep(double chord);
  /// Looks at a point and forgets all before it.
  void begin(const CurvePoint& here);

  /// The largest size of each function at the points that are kept.
  std::vector<double> sizes() const;

  /// What is kept, of this point first.
  const std::vector<Look>& kept() const { return kept_; }
  void restore(std::vector<Look> looks) { kept_ = std::move(looks); }

  /// Whether a function, or a real part of an eigenvalue, may vanish twice on the way to a point at this
  /// distance, where it has this value.
  bool function_may_vanish(std::size_t function, double distance, double value) const;
  bool rate_may_vanish(std::size_t rate, double distance, double value) const;

 private:
  bool may_vanish(std::vector<double> Look::*values, std::size_t index, double distance, double value) const;

  const Problem& problem_;
  const std::vector<UserEvent>& events_;
  std::vector<PointType> tests_;
  bool spectral_ = true;
  long looks_ = 0;
  long spectra_ = 0;
  Vector values_;
  std::vector<double> functions_;
  ComplexVector eigenvalues_;
  int unstable_ = -1;
  std::vector<Look> kept_;
  std::string none_;
};

/// The signs at the start of a piece.
Signs signs_at_start(const Stepper& stepper, const Watch& watch);

/// Takes over the signs at the end of a step. Whatever changes its sign within a step that ends at an event
/// is an event there itself, and what vanishes there has the sign of noise: known signs stay.
void update(Signs& signs, const Stepper& stepper, const Watch& watch, bool at_event);

}  // namespace arcslip::continuation
