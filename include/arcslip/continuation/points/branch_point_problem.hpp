#pragma once

// Branch points as an extended problem.

#include "arcslip/continuation/points/extended_problem.hpp"
#include "arcslip/continuation/problem/second_derivative.hpp"

namespace arcslip::continuation {

/// Simple branch points: [dF/du dF/dp_a] loses rank,
///
///   [psi^T g^T] [dF/du dF/dp_a b]
///               [C^T           0] = [0 0 1],    g = 0 (two conditions),
///
/// and F + e b = 0. With a further free parameter e stays zero only where branch points persist, as on
/// branches that symmetry or an invariant subspace keeps; elsewhere the curve is that of a perturbed problem.
class BranchPointProblem : public ExtendedProblem {
 public:
  /// `active` becomes an unknown. The base is kept by reference.
  BranchPointProblem(const Problem& base, Index active);

  [[nodiscard]] bool adapt(const BasePoint& point) override;

  /// Basis of the null space of [dF/du dF/dp_a] at the point last evaluated: (n + 1) x 2, in the problem's
  /// units, orthonormal in its scale where the borders were chosen.
  Matrix null_space() const;
  /// psi, n.
  Vector left_null() const { return left_.head(base().size()); }
  /// n + 1, the scale in which these are measured.
  Vector null_scale() const;

 protected:
  bool conditions(const BasePoint& point, Vector& values, Matrix* gradients) const override;
  void each_border(const std::function<void(double*, Index)>& use) override;
  double strain() const override;
  long own_evaluations() const override { return second_.evaluations(); }

 private:
  bool solve_borders() const;

  std::unique_ptr<BorderedSolver> solver_;
  double active_scale_ = 1;
  Matrix rows_;  // C, (n + 1) x 2
  mutable SecondDerivative second_;
  mutable Vector left_;      // (psi, g)
  mutable Vector right_[2];  // (w_j, .)
};

}  // namespace arcslip::continuation
