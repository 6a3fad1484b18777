#pragma once

// Values of the parameter on which a branch puts a point.

#include <vector>

#include "arcslip/continuation/problem.hpp"
#include "arcslip/continuation/trace.hpp"

namespace arcslip::continuation {

struct Target {
  enum class Kind { landmark, user, end, bound };
  double value;
  Kind kind;
};

class Targets {
 public:
  /// Throws std::invalid_argument for listed values outside the range.
  Targets(const Problem& problem, Index parameter, const TraceOptions& options);

  /// The nearest one within `reach` of `here` in the direction of travel; null if there is none. One nearer
  /// than `rounding` has been reached.
  const Target* ahead(double here, double direction, double reach, double rounding) const;

  /// Whether one lies between two values, by more than `rounding`.
  bool between(double a, double b, double rounding) const;

  /// The one at a value, to `tolerance`; null if there is none.
  const Target* at(double value, double tolerance) const;

 private:
  std::vector<Target> targets_;
};

}  // namespace arcslip::continuation
