#pragma once

// Values of the parameter on which a branch puts a point.

#include <vector>

#include "arcslip/continuation/path/trace.hpp"
#include "arcslip/continuation/problem/problem.hpp"

namespace arcslip::continuation {

/// One of them.
struct Target {
  /// A landmark of the problem, a listed value, the last value, the first one.
  enum class Kind { landmark, user, end, bound };
  double value;  ///< of the parameter
  Kind kind;     ///< where it comes from
};

/// Those of one trace, of which some are taken while the branch stands on them.
class Targets {
 public:
  /// Throws std::invalid_argument for listed values outside the range.
  Targets(const Problem& problem, Index parameter, const TraceOptions& options);

  /// The nearest one within `reach` of `here` in the direction of travel that is not taken; null if there is
  /// none. A landmark and the first value are reached when they are nearer than `rounding`; all others want a
  /// point of their own.
  const Target* ahead(double here, double direction, double reach, double rounding) const;

  /// Whether one that is not taken lies between two values, further than `tolerance` from the second. A
  /// landmark and the first value count only if they are further than `rough` from both.
  bool between(double a, double b, double tolerance, double rough) const;

  /// Those within `tolerance` of a value that are neither taken nor landmarks; the ends of the range come
  /// last.
  std::vector<const Target*> around(double value, double tolerance) const;

  /// Where a branch has put a point on a target, this is taken as long as the branch stays there.
  /// Where a branch has put a point on a target, this is taken as long as the branch stays there.
  void take(const Target& target) { taken_.push_back(&target); }
  void keep_taken(double value, double tolerance);
  std::vector<double> taken() const;
  void restore(const std::vector<double>& taken);

 private:
  static bool wants_point(const Target& target);
  bool is_taken(const Target& target) const;

  std::vector<Target> targets_;
  std::vector<const Target*> taken_;
};

}  // namespace arcslip::continuation
