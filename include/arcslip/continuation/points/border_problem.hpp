#pragma once

// Points on a border as an extended problem.

#include "arcslip/continuation/points/extended_problem.hpp"

namespace arcslip::continuation {

/// Points on a border of a regime; its turning points are the folds of this curve.
class BorderProblem : public ExtendedProblem {
 public:
  /// `active` becomes an unknown; `border` is one of the regime in which points are given.
  BorderProblem(const Problem& base, Index active, int border);

  /// Without that on which the points lie.
  int border_count(const Regime& regime) const override { return base().border_count(regime) - 1; }
  double border(const Vector& u, const Vector& p, const Regime& regime, int border,
                Gradient* gradient) const override;

 protected:
  bool conditions(const BasePoint& point, Vector& values, Matrix* gradients) const override;

 private:
  int border_;
  mutable Gradient slope_;
};

}  // namespace arcslip::continuation
