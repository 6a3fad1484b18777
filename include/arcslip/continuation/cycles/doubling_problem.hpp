#pragma once

// Period doublings of cycles as an extended problem.

#include "arcslip/continuation/cycles/cycle_problem.hpp"
#include "arcslip/continuation/points/extended_problem.hpp"
#include "arcslip/continuation/problem/second_derivative.hpp"

namespace arcslip::continuation {

/// Cycles with a multiplier -1: the variation v' = T f_u v with v(1) = -v(0) has a solution,
///
///   [J_-  b] [v]   [0]
///   [c^T  0] [g] = [1],    g = 0,
///
/// J_- the Jacobian of the cycle without T and phase, with the sign of u(0) changed in u(1) = u(0).
class DoublingProblem : public ExtendedProblem {
 public:
  /// `active` becomes an unknown. The base is kept by reference.
  DoublingProblem(const CycleProblem& base, Index active);

  [[nodiscard]] bool adapt(const BasePoint& point) override;

  /// v at the nodes, n x nodes, in the unknowns' units, of the point last adapted to.
  Vector variation() const { return right_.head(count_).cwiseProduct(scale_.head(count_)); }

 protected:
  bool conditions(const BasePoint& point, Vector& values, Matrix* gradients) const override;
  void each_border(const std::function<void(double*, Index)>& use) override;
  double strain() const override;
  long own_evaluations() const override { return second_.evaluations(); }

 private:
  [[nodiscard]] bool solve_borders() const;
  Vector padded(const Vector& v) const;

  Index unknowns_;  // of the field
  Index count_;     // of J_-
  std::unique_ptr<BorderedSolver> solver_;
  Vector column_;  // b
  Vector row_;     // c
  mutable SecondDerivative second_;
  mutable Vector right_;  // (v, g)
  mutable Vector left_;
};

}  // namespace arcslip::continuation
