#pragma once

// Extrema of an observable as an extended problem.

#include "arcslip/continuation/points/extended_problem.hpp"
#include "arcslip/continuation/problem/second_derivative.hpp"

namespace arcslip::continuation {

/// Extrema of an observable along the branch: the tangent t leaves Y as it is, so that a matrix is singular,
///
///   [dF/du    dF/dp_a     b] [t]   [0]
///   [grad Y / size        b] [g] = [0],    g = 0,
///   [c^T                  0]       [1]
///
/// as it also is where two branches cross that both have the extremum, but for one direction: there the curve
/// of extrema goes from one of them to the other.
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
  [[nodiscard]] bool solve_borders(const BasePoint& point) const;
  [[nodiscard]] bool fit_borders(const BasePoint& point);
  void along_tangent(Vector& du, Vector& dp) const;
  [[nodiscard]] bool change_of_slope(const BasePoint& point, Vector& out) const;
  [[nodiscard]] bool gradient(const BasePoint& point, Vector& out) const;

  Index observable_;
  std::unique_ptr<BorderedSolver> solver_;
  double active_scale_ = 1;
  double size_ = 1;  // of Y where the borders were chosen
  Vector column_;    // b, n + 1
  Vector row_;       // c, n + 1
  mutable SecondDerivative second_;
  mutable Gradient slope_;
  mutable Vector right_;  // (t, g), t in units of the scale
  mutable Vector left_;   // the same of the transposed matrix
};

}  // namespace arcslip::continuation
