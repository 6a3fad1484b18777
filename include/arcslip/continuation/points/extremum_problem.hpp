#pragma once

// Extrema of an observable as an extended problem.

#include "arcslip/continuation/points/extended_problem.hpp"
#include "arcslip/continuation/problem/second_derivative.hpp"

namespace arcslip::continuation {

/// Extrema of an observable along the branch: its derivative along the tangent t vanishes,
///
///   [dF/du dF/dp_a]     [0]
///   [c^T          ] t = [1],    g = grad Y . t / |Y| = 0.
class ExtremumProblem : public ExtendedProblem {
 public:
  /// `active` becomes an unknown; `observable` is the position of one with a gradient.
  ExtremumProblem(const Problem& base, Index active, Index observable);

  std::optional<Index> extremum_of() const override { return observable_; }

  [[nodiscard]] bool adapt(const BasePoint& point) override;

  /// d^2 Y/ds^2 along the branch at an extremum, the point last evaluated, with s in the problem's scale:
  /// negative at a peak. NaN where F or Y cannot be evaluated around it.
  double bend(const BasePoint& point) const;

 protected:
  bool conditions(const BasePoint& point, Vector& values, Matrix* gradients) const override;
  void each_border(const std::function<void(double*, Index)>& use) override;
  double strain() const override;
  long own_evaluations() const override { return second_.evaluations(); }

 private:
  [[nodiscard]] bool solve_tangent(const BasePoint& point) const;

  Index observable_;
  std::unique_ptr<BorderedSolver> solver_;
  double active_scale_ = 1;
  double size_ = 1;  // |Y| where the borders were chosen
  Vector row_;       // c, n + 1
  mutable SecondDerivative second_;
  mutable Gradient slope_;
  mutable Vector tangent_;  // in units of the scale
  mutable Vector adjoint_;
};

}  // namespace arcslip::continuation
