#pragma once

// What a branch is watched by beside its monitors: functions without derivatives, eigenvalues, and the signs
// last seen of everything.

#include <string>
#include <vector>

#include "arcslip/continuation/stepper.hpp"
#include "arcslip/continuation/trace.hpp"

namespace arcslip::continuation {

inline int sign_of(double value) { return (value > 0) - (value < 0); }

/// Sign of an observable's derivative, 0 below rounding of the observable; `monitor` is its own.
int sign_of_slope(const Stepper& stepper, std::size_t observable, const Monitor& monitor);

/// The functions without derivatives that a branch is watched by: the problem's tests, the user's events, and
/// the eigenvalues.
class Watch {
 public:
  Watch(const Problem& problem, const std::vector<UserEvent>& events);

  /// Evaluates all of them at a point.
  void look(const CurvePoint& point);

  const std::vector<double>& functions() const { return functions_; }  ///< tests, then events
  const ComplexVector& eigenvalues() const { return eigenvalues_; }    ///< by descending real part, or none
  int unstable() const { return unstable_; }                           ///< -1 without eigenvalues

  bool empty() const { return tests_.empty() && events_.empty() && !spectral_; }
  std::size_t test_count() const { return tests_.size(); }
  PointType pair_crossing() const { return problem_.pair_crossing(); }
  PointType type(std::size_t function) const;
  const std::string& label(std::size_t function) const;

 private:
  const Problem& problem_;
  const std::vector<UserEvent>& events_;
  std::vector<PointType> tests_;
  bool spectral_ = true;
  Vector values_;
  std::vector<double> functions_;
  ComplexVector eigenvalues_;
  int unstable_ = -1;
  std::string none_;
};

/// The signs at the start of a piece.
Signs signs_at_start(const Stepper& stepper, const Watch& watch);

/// Takes over the signs at the end of a step. Whatever changes its sign within a step that ends at an event
/// is an event there itself, and what vanishes there has the sign of noise: known signs stay.
void update(Signs& signs, const Stepper& stepper, const Watch& watch, bool at_event);

}  // namespace arcslip::continuation
