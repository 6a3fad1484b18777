#pragma once

// Where orbits come ever nearer to one that begins and ends on an equilibrium.

#include <array>
#include <limits>
#include <string>

#include "arcslip/continuation/cycles/orbit_problem.hpp"
#include "arcslip/continuation/path/branch.hpp"
#include "arcslip/continuation/points/extended_problem.hpp"

namespace arcslip::continuation {

/// Tells where the period grows while the parameter no longer changes, and the orbit all but rests on its
/// way. Relaxation oscillations grow as fast, without rest. Special orbits, which know their parameters less
/// well than others the nearer they come, may creep before they are there; and folds may no longer be any, as
/// what errors there are in the orbit's own multiplier 1 hides the second one. Where orbits go round another
/// one ever longer on their way, the branch goes to and fro between two values.
class GrowthWatch {
 public:
  /// Of a branch, or of this curve, over this parameter, of orbits with errors of this size. Kept by
  /// reference.
  GrowthWatch(const OrbitProblem& orbits, const std::string& parameter, double tolerance,
              const ExtendedProblem* curve = nullptr);

  /// Looks at the next orbit, which may be a fold of the branch.
  bool goes_on(const BasePoint& at, bool is_fold = false);

  /// Ends a branch there, with as many digits of the parameter as are known; or a curve that creeps.
  void end(Branch& branch) const;

 private:
  struct Fold {
    double value = std::numeric_limits<double>::quiet_NaN();
    double period = 0;
  };

  bool is_hidden(const BasePoint& at) const;
  bool snakes(const Fold& last, double same);

  const OrbitProblem& orbits_;
  const std::string& parameter_;
  double nearly_;  // of the parameter: its distance from its limit falls with e^-T until meshes hide it
  double value_ = std::numeric_limits<double>::quiet_NaN();
  double period_ = 0;  // the least at this value
  double last_period_ = 0;
  int points_ = 0;  // since then
  bool is_curve_;
  bool of_folds_;
  double surely_;  // how far ln of the multiplier of a fold may be from 0
  bool hidden_ = false;
  std::array<Fold, 4> folds_;  // the last ones, the latest first
  bool snakes_ = false;
  double crept_ = 0;  // a period, and a value, from which the last ones hardly differ
  double crept_to_ = 0;
  int crept_for_ = 0;  // points
};

}  // namespace arcslip::continuation
